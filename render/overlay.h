#pragma once

#include "render/camera.h"
#include "render/canvas.h"
#include "render/render_scene.h"

namespace pregrasp {

/// Draws the scene's caption, legend, labels and the grid's scale over a finished picture. Pictures
/// too small to hold readable text (under 200 x 112) get none.
/// @param grid_spacing  of the ground's squares [m]; 0 tells none.
void DrawOverlay(Image& image, FontSet& fonts, const RenderScene& scene, const CameraView& view,
                 double grid_spacing);

}  // namespace pregrasp
