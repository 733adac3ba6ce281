#include "app/recording/gzip_file.h"

#include <zlib.h>

#include <array>

#include "app/core/check.h"
#include "app/core/error.h"
#include "app/recording/checked_file.h"

namespace pregrasp {
namespace {

constexpr int kLevel = 6;
constexpr int kGzipWindow = 15 + 16;  // the largest window, with gzip's header and CRC
constexpr int kMemory = 8;            // zlib's default

// zlib does not write to what it reads from; its type only lacks the const.
Bytef* InputOf(std::string_view bytes) {
  return reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
}

}  // namespace

struct GzipFile::Impl {
  explicit Impl(const std::filesystem::path& path) : file(path) {
    PREGRASP_CHECK(deflateInit2(&stream, kLevel, Z_DEFLATED, kGzipWindow, kMemory,
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
  const std::string packed = ReadFile(file);
  z_stream stream{};
  PREGRASP_CHECK(inflateInit2(&stream, kGzipWindow) == Z_OK);
  const std::unique_ptr<z_stream, decltype(&inflateEnd)> cleanup(&stream, &inflateEnd);
  stream.next_in = InputOf(packed);
  stream.avail_in = static_cast<uInt>(packed.size());
  std::string bytes;
  std::array<char, 1 << 15> out{};
  int status = Z_OK;
  while (status == Z_OK) {
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = out.size();
    status = inflate(&stream, Z_NO_FLUSH);
    bytes.append(out.data(), out.size() - stream.avail_out);
  }
  if (status != Z_STREAM_END || stream.avail_in != 0) {
    throw InputError(file.string(), "", "a whole gzip file",
                     stream.msg != nullptr ? stream.msg : "one that is cut short or goes on");
  }
  return bytes;
}

}  // namespace pregrasp
