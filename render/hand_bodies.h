#pragma once

#include <array>
#include <string>
#include <vector>

#include "app/hand/hand_model.h"
#include "render/render_scene.h"

namespace pregrasp {

/// Adds a hand to a picture, as its URDF's visuals show it, but for the fingers' last links.
/// @param touching  fingers whose last links get the finger's colour; those of others have none.
/// @param marked_parts  names of links, or of their capsules ("palm/wrist"), in the colour of what
/// failed.
void AddHand(RenderScene& scene, const HandModel& hand, const HandConfiguration& configuration,
             const std::array<bool, kNumFingers>& touching = {},
             const std::vector<std::string>& marked_parts = {});

}  // namespace pregrasp
