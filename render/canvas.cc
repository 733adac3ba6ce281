#include "render/canvas.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pregrasp {
namespace {

std::array<float, 3> Srgb(const Rgba& color) {
  return {SrgbFromLinear(color.r), SrgbFromLinear(color.g), SrgbFromLinear(color.b)};
}

// Coverage of a pixel whose centre is `distance` pixels outside an edge (negative inside).
double EdgeCoverage(double distance) { return std::clamp(0.5 - distance, 0.0, 1.0); }

}  // namespace

float SrgbFromLinear(float linear) {
  if (!(linear > 0.0F)) return 0.0F;  // NaN too
  const float x = std::min(linear, 1.0F);
  return x <= 0.0031308F ? 12.92F * x : 1.055F * std::pow(x, 1.0F / 2.4F) - 0.055F;
}

void Canvas::Blend(int x, int y, const float* srgb, float alpha) {
  std::uint8_t* pixel = &image_.rgb[(static_cast<std::size_t>(y) * image_.width + x) * 3];
  for (int channel = 0; channel < 3; ++channel) {
    const float old = static_cast<float>(pixel[channel]);
    const float value = old + alpha * (255.0F * srgb[channel] - old);
    pixel[channel] = static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0F, 255.0F)));
  }
}

template <typename Coverage>
void Canvas::Fill(const Rect& bounds, const Rgba& color, const Coverage& coverage) {
  const std::array<float, 3> srgb = Srgb(color);
  const int x0 = std::max(0, static_cast<int>(std::floor(bounds.x)));
  const int y0 = std::max(0, static_cast<int>(std::floor(bounds.y)));
  const int x1 = std::min(image_.width, static_cast<int>(std::ceil(bounds.right())));
  const int y1 = std::min(image_.height, static_cast<int>(std::ceil(bounds.bottom())));
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) {
      const auto alpha = static_cast<float>(color.a * coverage(Vector2(x + 0.5, y + 0.5)));
      if (alpha > 0.0F) Blend(x, y, srgb.data(), alpha);
    }
  }
}

void Canvas::FillRect(const Rect& rect, const Rgba& color) {
  Fill(rect, color, [&rect](const Vector2& p) {
    const double w = std::min(p.x() + 0.5, rect.right()) - std::max(p.x() - 0.5, rect.x);
    const double h = std::min(p.y() + 0.5, rect.bottom()) - std::max(p.y() - 0.5, rect.y);
    return std::clamp(w, 0.0, 1.0) * std::clamp(h, 0.0, 1.0);
  });
}

void Canvas::FillRoundedRect(const Rect& rect, double radius, const Rgba& color) {
  const Vector2 half(0.5 * rect.width, 0.5 * rect.height);
  const double r = std::min(radius, std::min(half.x(), half.y()));
  Fill(rect.Grown(1.0), color, [&](const Vector2& p) {
    const Vector2 q = (p - rect.center()).cwiseAbs() - half + Vector2(r, r);
    return EdgeCoverage(q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0) - r);
  });
}

void Canvas::FillDisc(const Vector2& center, double radius, const Rgba& color) {
  const Rect bounds{center.x() - radius, center.y() - radius, 2.0 * radius, 2.0 * radius};
  Fill(bounds.Grown(1.0), color,
       [&](const Vector2& p) { return EdgeCoverage((p - center).norm() - radius); });
}

void Canvas::DrawLine(const Vector2& from, const Vector2& to, double width, const Rgba& color) {
  const Vector2 along = to - from;
  const double length2 = along.squaredNorm();
  const Vector2 low = from.cwiseMin(to), size = along.cwiseAbs();
  Fill(Rect{low.x(), low.y(), size.x(), size.y()}.Grown(0.5 * width + 1.0), color,
       [&](const Vector2& p) {
         const double t =
             length2 > 0.0 ? std::clamp((p - from).dot(along) / length2, 0.0, 1.0) : 0.0;
         return EdgeCoverage((p - from - t * along).norm() - 0.5 * width);
       });
}

double Canvas::DrawText(FontFace face, float size, const Vector2& baseline, std::string_view text,
                        const Rgba& color) {
  const std::array<float, 3> srgb = Srgb(color);
  double pen = baseline.x();
  const int row = static_cast<int>(std::lround(baseline.y()));
  char32_t last = 0;
  for (const char32_t c : DecodeUtf8(text)) {
    if (last != 0) pen += fonts_.Kerning(face, size, last, c);
    last = c;
    const double quarter = std::floor(pen * 4.0 + 0.5);
    const int column = static_cast<int>(std::floor(quarter / 4.0));
    const Glyph& glyph = fonts_.GetGlyph(face, size, c, static_cast<int>(quarter) - 4 * column);
    for (int j = 0; j < glyph.height; ++j) {
      const int y = row - glyph.top + j;
      if (y < 0 || y >= image_.height) continue;
      for (int i = 0; i < glyph.width; ++i) {
        const int x = column + glyph.left + i;
        if (x < 0 || x >= image_.width) continue;
        const float coverage = glyph.coverage[static_cast<std::size_t>(j) * glyph.width + i];
        if (coverage > 0.0F) Blend(x, y, srgb.data(), color.a * coverage / 255.0F);
      }
    }
    pen += glyph.advance;
  }
  return pen;
}

}  // namespace pregrasp
