#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/scene/finger.h"
#include "app/scene/scene.h"

namespace pregrasp {

/// One pose of a known motion of the object, and the contact that keeps it there.
struct LadderPose {
  struct Press {
    Finger finger = Finger::kIndex;  ///< thumb or index
    Vector3 p_OC = Vector3::Zero();
  };
  RigidTransform X_WO = RigidTransform::Identity();
  std::optional<Press> press;  ///< none where the object stays by itself
};

/// A motion known to lead from a scene's start to where a hand can grasp the object, as development
/// data: it tells planner, score and generator apart, and the planner never reads it.
struct Ladder {
  std::string name;               ///< of its file, without folder and extension
  Scene scene;                    ///< loaded
  std::vector<LadderPose> poses;  ///< at least two, from the start on
};

}  // namespace pregrasp
