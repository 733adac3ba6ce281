#pragma once

#include <string>
#include <vector>

#include "render/camera.h"
#include "render/canvas.h"
#include "render/render_scene.h"

namespace pregrasp {

/// Breaks prose into lines no wider than `width` pixels, at blanks; a single word that is wider is
/// cut with an ellipsis.
std::vector<std::string> WrapText(FontSet& fonts, FontFace face, float size,
                                  const std::string& text, double width);

/// Cuts a line with an ellipsis where it would be wider than `width` pixels.
std::string FitText(FontSet& fonts, FontFace face, float size, const std::string& text,
                    double width);

/// Draws the scene's caption, legend, labels and the grid's scale over a finished picture. Pictures
/// too small to hold readable text (under 200 x 112) get none.
/// @param grid_spacing  of the ground's squares [m]; 0 tells none.
void DrawOverlay(Image& image, FontSet& fonts, const RenderScene& scene, const CameraView& view,
                 double grid_spacing);

}  // namespace pregrasp
