#pragma once

#include <string>
#include <string_view>

namespace pregrasp {

/// gzip's settings of all that the house writes: without time and name, same content, same bytes.
inline constexpr int kGzipLevel = 6;
inline constexpr int kGzipWindow = 15 + 16;  ///< the largest window, with gzip's header and CRC
inline constexpr int kGzipMemory = 8;        ///< zlib's default

/// The bytes as a gzip file.
std::string Deflate(std::string_view bytes);

/// The content of a gzip file given as bytes. @throws InputError naming `where` if it is cut short,
/// damaged, or goes on behind its end.
std::string Inflate(std::string_view packed, const std::string& where);

}  // namespace pregrasp
