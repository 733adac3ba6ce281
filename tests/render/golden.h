#pragma once

#include <string>

#include "render/renderer.h"

namespace pregrasp {

/// Draws the scene and compares it with the stored picture of that name. Mesa compiles its
/// rasteriser for the processor at hand, so that the last bit of a pixel, and now and then a pixel
/// on an edge, may differ elsewhere: one level is allowed everywhere, and a few outliers. After a
/// wanted change: PREGRASP_UPDATE_GOLDEN=1 ctest -L golden, and look at every picture that changed.
void ExpectGolden(const std::string& name, const RenderScene& scene, RenderQuality quality);

}  // namespace pregrasp
