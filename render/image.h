#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace pregrasp {

/// 8-bit sRGB, row-major from the top left, three bytes a pixel.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

/// Deterministic bytes: no time stamp. @throws InputError if the file cannot be written or read;
/// Interrupted, with no file left.
void WritePng(const Image& image, const std::filesystem::path& file);
Image ReadPng(const std::filesystem::path& file);

}  // namespace pregrasp
