#include "render/jpeg.h"

// jpeglib.h takes FILE and size_t for known.
#include <csetjmp>
#include <cstdio>
#include <cstdlib>
//
#include <jpeglib.h>

#include "app/core/check.h"

namespace pregrasp {
namespace {

// As of libpng (image.cc): no exception through C frames.
struct JpegError {
  jpeg_error_mgr base;
  std::jmp_buf back;
};

void OnJpegError(j_common_ptr compress) {
  std::longjmp(reinterpret_cast<JpegError*>(compress->err)->back, 1);  // base is its first member
}

// Holds no C++ object made after setjmp.
bool Compress(jpeg_compress_struct& compress, JpegError& error, const Image& image, int quality,
              unsigned char** bytes,
              unsigned long* size) {  // NOLINT(google-runtime-int): libjpeg's
  if (setjmp(error.back) != 0) return false;
  jpeg_create_compress(&compress);
  jpeg_mem_dest(&compress, bytes, size);
  compress.image_width = static_cast<JDIMENSION>(image.width);
  compress.image_height = static_cast<JDIMENSION>(image.height);
  compress.input_components = 3;
  compress.in_color_space = JCS_RGB;
  jpeg_set_defaults(&compress);
  jpeg_set_quality(&compress, quality, TRUE);
  compress.optimize_coding = TRUE;
  for (int i = 0; i < compress.num_components; ++i) {
    compress.comp_info[i].h_samp_factor = compress.comp_info[i].v_samp_factor = 1;
  }
  jpeg_start_compress(&compress, TRUE);
  while (compress.next_scanline < compress.image_height) {
    const std::size_t at = static_cast<std::size_t>(compress.next_scanline) * image.width * 3;
    auto* row = const_cast<JSAMPROW>(&image.rgb[at]);  // which libjpeg only reads
    jpeg_write_scanlines(&compress, &row, 1);
  }
  jpeg_finish_compress(&compress);
  return true;
}

}  // namespace

std::string EncodeJpeg(const Image& image, int quality) {
  PREGRASP_CHECK(image.width > 0 && image.height > 0 && quality >= 1 && quality <= 100, image.width,
                 image.height, quality);
  PREGRASP_CHECK(image.rgb.size() == static_cast<std::size_t>(image.width) * image.height * 3,
                 image.rgb.size());
  JpegError error;
  jpeg_compress_struct compress{};
  compress.err = jpeg_std_error(&error.base);
  error.base.error_exit = OnJpegError;
  unsigned char* bytes = nullptr;
  unsigned long size = 0;  // NOLINT(google-runtime-int): libjpeg's
  const bool ok = Compress(compress, error, image, quality, &bytes, &size);
  std::string text;
  if (ok) text.assign(reinterpret_cast<const char*>(bytes), size);
  jpeg_destroy_compress(&compress);
  std::free(bytes);
  PREGRASP_CHECK(ok, image.width, image.height);
  return text;
}

}  // namespace pregrasp
