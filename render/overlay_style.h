#pragma once

#include <algorithm>
#include <cmath>

#include "render/image.h"
#include "render/palette.h"

namespace pregrasp {

/// Sizes and colours of what is written over a picture. Sizes are named at 1280 x 720 and scale
/// with the picture.
struct OverlayStyle {
  double scale = 1.0;
  float title = 20.0F, text = 14.0F, small = 12.5F;  ///< of type [pixels]
  Rgba panel = FromSrgb(0x20262F, 0.88F);
  Rgba accent = ObjectColor();
  Rgba bright = FromSrgb(0xFFFFFF), normal = FromSrgb(0xDCE2EA), muted = FromSrgb(0xA8B3C2);
  Rgba on_floor = FromSrgb(0x5A6470);  ///< of text without a panel

  OverlayStyle(const Image& image, double font_scale)
      : scale(std::clamp(std::min(image.width / 1280.0, image.height / 720.0), 0.66, 6.0)) {
    // Below about ten pixels letters fill in: text shrinks more slowly than the rest.
    const auto sized = [this, font_scale](float size) {
      const double pixels = font_scale * std::max<double>(size * scale, 0.4 * size + 3.6);
      return static_cast<float>(std::round(pixels * 4.0) / 4.0);
    };
    title = sized(title);
    text = sized(text);
    small = sized(small);
  }

  double px(double at_720) const { return std::round(at_720 * scale); }
};

}  // namespace pregrasp
