#include "render/palette.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace pregrasp {
namespace {

float LinearFromSrgb(float s) {
  return s <= 0.04045F ? s / 12.92F : std::pow((s + 0.055F) / 1.055F, 2.4F);
}

struct Oklab {
  double l, a, b;
};

// Ottosson, "A perceptual color space for image processing", 2020.
Rgba FromOklab(const Oklab& c) {
  const double l = std::pow(c.l + 0.3963377774 * c.a + 0.2158037573 * c.b, 3.0);
  const double m = std::pow(c.l - 0.1055613458 * c.a - 0.0638541728 * c.b, 3.0);
  const double s = std::pow(c.l - 0.0894841775 * c.a - 1.2914855480 * c.b, 3.0);
  const auto channel = [](double value) { return static_cast<float>(std::clamp(value, 0.0, 1.0)); };
  return {channel(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
          channel(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
          channel(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s), 1.0F};
}

}  // namespace

Rgba FromSrgb(std::uint32_t rgb, float alpha) {
  const auto channel = [rgb](int shift) {
    return LinearFromSrgb(static_cast<float>((rgb >> shift) & 0xFFU) / 255.0F);
  };
  return {channel(16), channel(8), channel(0), alpha};
}

Rgba ObjectColor() { return FromSrgb(0xE0A02C); }
Rgba NeighbourColor() { return FromSrgb(0x4E93A2); }
Rgba StaticColor() { return FromSrgb(0xC9CCD0); }
Rgba TableColor() { return FromSrgb(0xD9C7A8); }
Rgba HandColor() { return FromSrgb(0xA9B1BC); }
Rgba GoodColor() { return FromSrgb(0x009E73); }
Rgba BadColor() { return FromSrgb(0xD55E00); }
Rgba NeutralColor() { return FromSrgb(0x8A9099); }

Rgba FingerColor(Finger finger) {
  static constexpr std::array<std::uint32_t, kNumFingers> kColors = {0xC23C9A, 0xE04A26, 0xF2CF2E,
                                                                     0x1FA772, 0x2F7FD0};
  return FromSrgb(kColors[static_cast<int>(finger)]);
}

Rgba ScoreColor(double value) {
  if (std::isnan(value)) return NeutralColor();
  // Lightness even from .30 to .93; hue turns from blue over teal to yellow.
  static constexpr std::array<Oklab, 4> kAnchors = {{{0.30, 0.020, -0.115},
                                                     {0.51, -0.060, -0.060},
                                                     {0.72, -0.100, 0.055},
                                                     {0.93, -0.020, 0.155}}};
  const double t = std::clamp(value, 0.0, 1.0) * (kAnchors.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(t), kAnchors.size() - 2);
  const double f = t - static_cast<double>(i);
  const Oklab& p = kAnchors[i];
  const Oklab& q = kAnchors[i + 1];
  return FromOklab({p.l + f * (q.l - p.l), p.a + f * (q.a - p.a), p.b + f * (q.b - p.b)});
}

RenderBody WithLook(RenderBody body, const Rgba& color, float roughness, float metallic) {
  body.color = color;
  body.roughness = roughness;
  body.metallic = metallic;
  return body;
}

}  // namespace pregrasp
