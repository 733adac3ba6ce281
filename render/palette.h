#pragma once

#include <cstdint>

#include "app/scene/finger.h"
#include "render/render_scene.h"

namespace pregrasp {

/// A colour from its usual name 0xRRGGBB in sRGB.
Rgba FromSrgb(std::uint32_t rgb, float alpha = 1.0F);

/// The same colour with another opacity.
inline Rgba WithAlpha(Rgba color, float alpha) {
  color.a = alpha;
  return color;
}

// The picture's roles. Hues are told apart by the common forms of colour blindness, after Okabe and
// Ito ("Color universal design", 2008): they differ in lightness as well.
Rgba ObjectColor();     ///< what is to be grasped: amber
Rgba NeighbourColor();  ///< other things that move: teal
Rgba StaticColor();     ///< walls and shelves: light grey
Rgba TableColor();      ///< a supporting surface: pale birch
Rgba HandColor();       ///< links of the hand: blue-grey
Rgba GoodColor();       ///< kept, feasible, within limits
Rgba BadColor();        ///< pruned, failed, beyond limits
Rgba NeutralColor();    ///< neither
/// Thumb magenta, index vermilion, middle yellow, ring green, little blue.
Rgba FingerColor(Finger finger);
/// A value in [0, 1] as colour, from dark blue through green to pale yellow: lightness rises
/// evenly, so that it reads in grey and by colour-blind eyes. Values outside are clamped, NaN is
/// grey.
Rgba ScoreColor(double value);

/// Gives a body the surface of its role: colour and roughness.
RenderBody WithLook(RenderBody body, const Rgba& color, float roughness = 0.55F,
                    float metallic = 0.0F);

}  // namespace pregrasp
