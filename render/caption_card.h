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

/// What a card or a legend has to keep clear of.
struct CardArea {
  double bottom = 0.0;                         ///< it ends above this [pixels]
  std::optional<Rect> taken;                   ///< and goes to no other corner that overlaps this
  std::vector<std::vector<Vector2>> outlines;  ///< convex; of these it covers as little as it can
  bool top_is_free = false;                    ///< of a legend: there is no card
};

/// Draws the caption's title and lines and returns the card, or nothing if there is nothing to say:
/// at the picture's top left, or at the top right or bottom left where it covers clearly less. What
/// does not fit is left out, and an ellipsis says so.
std::optional<Rect> DrawCaptionCard(Canvas& canvas, FontSet& fonts, const OverlayStyle& style,
                                    const RenderCaption& caption, const CardArea& area);

/// Draws the legend at the lower right, or at the lower left, or where the top is free at the upper
/// right, if it covers clearly less there; nothing if it is empty or does not fit.
std::optional<Rect> DrawLegend(Canvas& canvas, FontSet& fonts, const OverlayStyle& style,
                               const RenderLegend& legend, const CardArea& area);

}  // namespace pregrasp
