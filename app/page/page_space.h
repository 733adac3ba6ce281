#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "app/recording/loaded_run.h"
#include "render/render_scene.h"

namespace pregrasp {

/// What the page's 3D views draw, as the JSON that assets/space.js reads: every body's mesh and the
/// hand's, each once and with few triangles; where all of them are at each of `steps` and at each
/// frame of the hand's motion, or, for a run without one, of the simulated trajectory.
/// @param steps  in the order of the page's slider; null for one without a place in space.
nlohmann::ordered_json PageSpace(const LoadedRun& run, const std::vector<const StepFacts*>& steps);

/// A picture's colour as the page writes it: "#e0a02c".
std::string CssColor(const Rgba& color);

}  // namespace pregrasp
