#include "render/font.h"

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

#include <array>
#include <cmath>

#include "app/core/check.h"
#include "app/core/error.h"

namespace pregrasp {
namespace {

constexpr const char* kFolder = "/usr/share/fonts/truetype/dejavu/";
constexpr std::array<const char*, 3> kFiles = {"DejaVuSans.ttf", "DejaVuSans-Bold.ttf",
                                               "DejaVuSansMono.ttf"};
constexpr char32_t kReplacement = 0xFFFD;

}  // namespace

std::u32string DecodeUtf8(std::string_view text) {
  std::u32string out;
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i++]);
    if (lead < 0x80) {
      out += lead;
      continue;
    }
    const int more = lead >= 0xF0 && lead < 0xF5 ? 3 : lead >= 0xE0 ? 2 : lead >= 0xC2 ? 1 : 0;
    char32_t value = lead & (0x3FU >> more);
    int taken = 0;
    while (lead < 0xF5 && taken < more && i < text.size() && (text[i] & 0xC0) == 0x80) {
      value = (value << 6) | (static_cast<unsigned char>(text[i++]) & 0x3FU);
      ++taken;
    }
    out += more > 0 && taken == more ? value : kReplacement;
  }
  return out;
}

std::string EncodeUtf8(std::u32string_view text) {
  std::string out;
  for (const char32_t c : text) {
    if (c < 0x80) {
      out += static_cast<char>(c);
    } else if (c < 0x800) {
      out += {static_cast<char>(0xC0 | (c >> 6)), static_cast<char>(0x80 | (c & 0x3F))};
    } else if (c < 0x10000) {
      out += {static_cast<char>(0xE0 | (c >> 12)), static_cast<char>(0x80 | ((c >> 6) & 0x3F)),
              static_cast<char>(0x80 | (c & 0x3F))};
    } else {
      out += {static_cast<char>(0xF0 | (c >> 18)), static_cast<char>(0x80 | ((c >> 12) & 0x3F)),
              static_cast<char>(0x80 | ((c >> 6) & 0x3F)), static_cast<char>(0x80 | (c & 0x3F))};
    }
  }
  return out;
}

struct FontSet::Impl {
  FT_Library library = nullptr;
  std::array<FT_Face, kFiles.size()> faces{};
  std::map<std::tuple<int, int, char32_t, int>, Glyph> glyphs;

  FT_Face Sized(FontFace face, float size) {
    FT_Face ft = faces[static_cast<int>(face)];
    FT_Set_Char_Size(ft, 0, static_cast<FT_F26Dot6>(std::lround(size * 64.0F)), 72, 72);
    return ft;
  }
};

FontSet::FontSet() : impl_(std::make_unique<Impl>()) {
  const FT_Error error = FT_Init_FreeType(&impl_->library);
  PREGRASP_CHECK(error == 0, error);
  for (std::size_t i = 0; i < kFiles.size(); ++i) {
    const std::string file = std::string(kFolder) + kFiles[i];
    if (FT_New_Face(impl_->library, file.c_str(), 0, &impl_->faces[i]) != 0) {
      FT_Done_FreeType(impl_->library);
      throw InputError(file, "", "a font file (Debian package fonts-dejavu-core)", "");
    }
  }
}

FontSet::~FontSet() { FT_Done_FreeType(impl_->library); }

const Glyph& FontSet::GetGlyph(FontFace face, float size, char32_t character, int phase) {
  const auto key = std::make_tuple(static_cast<int>(face),
                                   static_cast<int>(std::lround(size * 64.0F)), character, phase);
  if (const auto found = impl_->glyphs.find(key); found != impl_->glyphs.end()) {
    return found->second;
  }
  FT_Face ft = impl_->Sized(face, size);
  Glyph glyph;
  if (character < U' ') character = U' ';  // line breaks and the like have no picture
  // Light hinting snaps heights to the pixel grid and leaves widths alone.
  if (FT_Load_Char(ft, character, FT_LOAD_TARGET_LIGHT) == 0) {
    glyph.advance = static_cast<float>(ft->glyph->linearHoriAdvance) / 65536.0F;
    FT_Outline_Translate(&ft->glyph->outline, FT_Pos{16} * phase, 0);
    if (FT_Render_Glyph(ft->glyph, FT_RENDER_MODE_NORMAL) == 0) {
      const FT_Bitmap& bitmap = ft->glyph->bitmap;
      glyph.width = static_cast<int>(bitmap.width);
      glyph.height = static_cast<int>(bitmap.rows);
      glyph.left = ft->glyph->bitmap_left;
      glyph.top = ft->glyph->bitmap_top;
      glyph.coverage.reserve(static_cast<std::size_t>(glyph.width) * glyph.height);
      for (int row = 0; row < glyph.height; ++row) {
        const unsigned char* line = bitmap.buffer + static_cast<std::ptrdiff_t>(row) * bitmap.pitch;
        glyph.coverage.insert(glyph.coverage.end(), line, line + glyph.width);
      }
    }
  }
  return impl_->glyphs.emplace(key, std::move(glyph)).first->second;
}

float FontSet::Kerning(FontFace face, float size, char32_t left, char32_t right) {
  if (face == FontFace::kMono) return 0.0F;
  FT_Face ft = impl_->Sized(face, size);
  FT_Vector delta{};
  FT_Get_Kerning(ft, FT_Get_Char_Index(ft, left), FT_Get_Char_Index(ft, right), FT_KERNING_UNFITTED,
                 &delta);
  return static_cast<float>(delta.x) / 64.0F;
}

float FontSet::TextWidth(FontFace face, float size, std::string_view text) {
  float width = 0.0F;
  char32_t last = 0;
  for (const char32_t c : DecodeUtf8(text)) {
    if (last != 0) width += Kerning(face, size, last, c);
    width += GetGlyph(face, size, c).advance;
    last = c;
  }
  return width;
}

float FontSet::CapHeight(FontFace face, float size) {
  return static_cast<float>(GetGlyph(face, size, U'H').top);
}

}  // namespace pregrasp
