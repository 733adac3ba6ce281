#pragma once

#include <cstdint>

#include "app/motion/motion_task.h"
#include "app/scene/scene.h"

namespace pregrasp {

/// A motion to be made: the object's path and contacts are given, not simulated.
struct MotionProblem {
  std::uint64_t seed = 0;  ///< that it was made from
  Scene scene;
  MotionTask task;
  HandConfiguration grasp;
};

/// A box on a table beside a wall slides 5 to 12 cm and yaws, pushed by two fingers; these let go,
/// and after a wait two touch elsewhere and push on; then five close and the box goes up by 10 cm.
/// Contacts and the last pose come from a random hand that can hold it.
MotionProblem MakeMotionProblem(std::uint64_t seed);

}  // namespace pregrasp
