#include "app/recording/gzip_file.h"

#include <zlib.h>

#include <array>

#include "app/core/check.h"
#include "app/core/gzip.h"
#include "app/recording/checked_file.h"

namespace pregrasp {
namespace {

// zlib does not write to what it reads from; its type only lacks the const.
Bytef* InputOf(std::string_view bytes) {
  return reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
}

}  // namespace

struct GzipFile::Impl {
  explicit Impl(const std::filesystem::path& path) : file(path) {
    PREGRASP_CHECK(deflateInit2(&stream, kGzipLevel, Z_DEFLATED, kGzipWindow, kGzipMemory,
                                Z_DEFAULT_STRATEGY) == Z_OK);
  }
  ~Impl() { deflateEnd(&stream); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void Deflate(std::string_view bytes, int flush) {
    stream.next_in = InputOf(bytes);
    stream.avail_in = static_cast<uInt>(bytes.size());
    std::array<char, 1 << 15> out{};
    do {
      stream.next_out = reinterpret_cast<Bytef*>(out.data());
      stream.avail_out = out.size();
      const int status = deflate(&stream, flush);
      PREGRASP_CHECK(status != Z_STREAM_ERROR, status);
      file.Write({out.data(), out.size() - stream.avail_out});
    } while (stream.avail_out == 0);
  }

  CheckedFile file;
  z_stream stream{};
};

GzipFile::GzipFile(const std::filesystem::path& file) : impl_(std::make_unique<Impl>(file)) {}
GzipFile::~GzipFile() = default;

void GzipFile::Write(std::string_view bytes) { impl_->Deflate(bytes, Z_NO_FLUSH); }

void GzipFile::Close() {
  impl_->Deflate({}, Z_FINISH);
  impl_->file.Close();
}

std::string ReadGzipFile(const std::filesystem::path& file) {
  return Inflate(ReadFile(file), file.string());
}

}  // namespace pregrasp
