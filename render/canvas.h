#pragma once

#include <string_view>

#include "app/core/math.h"
#include "render/font.h"
#include "render/image.h"
#include "render/render_scene.h"

namespace pregrasp {

/// An axis-aligned rectangle in pixels, x to the right and y down, as pictures are stored.
struct Rect {
  double x = 0.0, y = 0.0, width = 0.0, height = 0.0;

  double right() const { return x + width; }
  double bottom() const { return y + height; }
  Vector2 center() const { return {x + 0.5 * width, y + 0.5 * height}; }
  bool Overlaps(const Rect& other) const {
    return x < other.right() && other.x < right() && y < other.bottom() && other.y < bottom();
  }
  bool Contains(const Vector2& p) const {
    return p.x() >= x && p.x() <= right() && p.y() >= y && p.y() <= bottom();
  }
  Rect Grown(double margin) const {
    return {x - margin, y - margin, width + 2.0 * margin, height + 2.0 * margin};
  }
};

/// Anti-aliased drawing in two dimensions onto a finished picture, in software, so that text and
/// cards have the same bytes whatever drew the picture. Everything is clipped to the picture;
/// colours blend by their opacity in sRGB.
class Canvas {
 public:
  Canvas(Image& image, FontSet& fonts) : image_(image), fonts_(fonts) {}

  double width() const { return image_.width; }
  double height() const { return image_.height; }

  void FillRect(const Rect& rect, const Rgba& color);
  void FillRoundedRect(const Rect& rect, double radius, const Rgba& color);
  void FillDisc(const Vector2& center, double radius, const Rgba& color);
  void DrawLine(const Vector2& from, const Vector2& to, double width, const Rgba& color);
  /// Draws one line of UTF-8 text; `baseline` is where its pen starts. Returns the pen's end.
  double DrawText(FontFace face, float size, const Vector2& baseline, std::string_view text,
                  const Rgba& color);

 private:
  template <typename Coverage>
  void Fill(const Rect& bounds, const Rgba& color, const Coverage& coverage);
  void Blend(int x, int y, const float* srgb, float alpha);

  Image& image_;
  FontSet& fonts_;
};

/// One channel of linear light as sRGB, both 0 to 1.
float SrgbFromLinear(float linear);

}  // namespace pregrasp
