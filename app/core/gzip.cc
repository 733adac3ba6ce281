#include "app/core/gzip.h"

#include <zlib.h>

#include <array>
#include <memory>

#include "app/core/check.h"
#include "app/core/error.h"

namespace pregrasp {
namespace {

// zlib does not write to what it reads from; its type only lacks the const.
void SetInput(std::string_view bytes, z_stream* stream) {
  stream->next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream->avail_in = static_cast<uInt>(bytes.size());
}

// Runs `step` until it has no more to say. @return its last status.
template <typename Step>
int Collect(z_stream* stream, const Step& step, std::string* bytes) {
  std::array<char, 1 << 15> out{};
  int status = Z_OK;
  while (status == Z_OK) {
    stream->next_out = reinterpret_cast<Bytef*>(out.data());
    stream->avail_out = out.size();
    status = step();
    bytes->append(out.data(), out.size() - stream->avail_out);
  }
  return status;
}

}  // namespace

std::string Deflate(std::string_view bytes) {
  z_stream stream{};
  PREGRASP_CHECK(deflateInit2(&stream, kGzipLevel, Z_DEFLATED, kGzipWindow, kGzipMemory,
                              Z_DEFAULT_STRATEGY) == Z_OK);
  const std::unique_ptr<z_stream, decltype(&deflateEnd)> cleanup(&stream, &deflateEnd);
  SetInput(bytes, &stream);
  std::string packed;
  const int status = Collect(
      &stream, [&] { return deflate(&stream, Z_FINISH); }, &packed);
  PREGRASP_CHECK(status == Z_STREAM_END, status);
  return packed;
}

std::string Inflate(std::string_view packed, const std::string& where) {
  z_stream stream{};
  PREGRASP_CHECK(inflateInit2(&stream, kGzipWindow) == Z_OK);
  const std::unique_ptr<z_stream, decltype(&inflateEnd)> cleanup(&stream, &inflateEnd);
  SetInput(packed, &stream);
  std::string bytes;
  const int status = Collect(
      &stream, [&] { return inflate(&stream, Z_NO_FLUSH); }, &bytes);
  if (status != Z_STREAM_END || stream.avail_in != 0) {
    throw InputError(where, "", "a whole gzip file",
                     stream.msg != nullptr ? stream.msg : "one that is cut short or goes on");
  }
  return bytes;
}

}  // namespace pregrasp
