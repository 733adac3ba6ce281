#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/canvas.h"
#include "render/overlay_style.h"
#include "render/render_scene.h"

namespace pregrasp {

/// Breaks prose into lines no wider than `width` pixels, at blanks; a single word that is wider is
/// cut with an ellipsis.
std::vector<std::string> WrapText(FontSet& fonts, FontFace face, float size,
                                  const std::string& text, double width);

/// Cuts a line with an ellipsis where it would be wider than `width` pixels.
std::string FitText(FontSet& fonts, FontFace face, float size, const std::string& text,
                    double width);

/// Draws the caption's title and lines at the picture's top left and returns the card, or nothing
/// if there is nothing to say. What does not fit above `bottom` is left out, and an ellipsis says
/// so.
std::optional<Rect> DrawCaptionCard(Canvas& canvas, FontSet& fonts, const OverlayStyle& style,
                                    const RenderCaption& caption, double bottom);

/// Draws the legend at the lower right, above `bottom`; nothing if it is empty or does not fit.
std::optional<Rect> DrawLegend(Canvas& canvas, FontSet& fonts, const OverlayStyle& style,
                               const RenderLegend& legend, double bottom);

}  // namespace pregrasp
