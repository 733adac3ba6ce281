#pragma once

#include <array>
#include <memory>
#include <vector>

#include "app/hand/hand_kinematics.h"
#include "app/scene/shape.h"

namespace pregrasp {

/// A picture mesh that moves with a link, in the link's frame.
struct HandShape {
  int link = 0;
  std::shared_ptr<const TriangleMesh> mesh;
  std::array<float, 4> rgba{};  ///< linear, as the URDF's material says
};

/// What to draw of a hand: the visuals of its URDF. A mesh that several links use is shared.
/// @throws InputError  a file that is missing or not as ParseObj wants it.
std::vector<HandShape> LoadHandShapes(const HandModel& hand);

/// Those of ShadowHand(), read once.
const std::vector<HandShape>& ShadowHandShapes();

/// X_WL of every link.
std::array<RigidTransform, kNumHandLinks> CalcLinkPoses(const HandModel& hand,
                                                        const HandConfiguration& configuration);

}  // namespace pregrasp
