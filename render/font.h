#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

namespace pregrasp {

enum class FontFace { kSans, kBold, kMono };

/// One character's coverage, 0 to 255, row-major; `left` and `top` place it from the pen, which
/// stands on the baseline (`top` upwards).
struct Glyph {
  int width = 0, height = 0, left = 0, top = 0;
  float advance = 0.0F;  ///< [pixels]
  std::vector<std::uint8_t> coverage;
};

/// Decodes UTF-8; a malformed byte becomes U+FFFD.
std::u32string DecodeUtf8(std::string_view text);
std::string EncodeUtf8(std::u32string_view text);

/// DejaVu's faces through FreeType, as Debian's fonts-dejavu-core installs them; glyphs are cached.
class FontSet {
 public:
  /// @throws InputError if a font file is missing.
  FontSet();
  ~FontSet();
  FontSet(const FontSet&) = delete;
  FontSet& operator=(const FontSet&) = delete;

  /// @param size   height of the em square [pixels], a multiple of 1/64.
  /// @param phase  sub-pixel position of the pen, in quarters of a pixel (0 to 3).
  const Glyph& GetGlyph(FontFace face, float size, char32_t character, int phase = 0);

  /// Width of a line of text with kerning [pixels].
  float TextWidth(FontFace face, float size, std::string_view text);
  float Kerning(FontFace face, float size, char32_t left, char32_t right);
  /// Height of a capital letter [pixels].
  float CapHeight(FontFace face, float size);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pregrasp
