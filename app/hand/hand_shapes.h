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
/// @throws InputError  for a file that has no triangles.
std::vector<HandShape> LoadHandShapes(const HandModel& hand);

/// The same, read once in a process for a hand of FindHand, and kept.
const std::vector<HandShape>& ShapesOf(const HandModel& hand);

/// X_WL of every link.
std::vector<RigidTransform> CalcLinkPoses(const HandModel& hand,
                                          const HandConfiguration& configuration);

}  // namespace pregrasp
