#pragma once

#include <array>

#include "app/hand/hand_model.h"
#include "render/render_scene.h"

namespace pregrasp {

/// Adds a hand to a picture, as its URDF's visuals show it.
/// @param touching  fingers whose last links get the finger's colour.
void AddHand(RenderScene& scene, const HandModel& hand, const HandConfiguration& configuration,
             const std::array<bool, kNumFingers>& touching = {});

}  // namespace pregrasp
