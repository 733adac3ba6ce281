#pragma once

#include "app/core/thread_pool.h"
#include "app/dynamics/world.h"
#include "app/studies/ladder.h"

namespace pregrasp {

/// A state in which the object is at a pose set by hand.
struct HeldState {
  WorldState state;       ///< if it holds, where it came to rest; else the pose itself, fingers on
  bool holds = false;     ///< it moves under 1 cm and 5 degrees in 1 s, and the state is finite
  double shift = 0.0;     ///< in that second [m]
  double turn_deg = 0.0;  ///< [degrees]
};

/// Puts the object at a ladder's pose and the pressing finger on its contact, with the target that
/// keeps the object most still for a second: of a grid of forces up to the cap, inside nine tenths
/// of the cone, each simulated. The others bodies are where they start.
/// @param pool  for the simulations; cannot change the result.
HeldState FindHoldingPress(const World& world, const LadderPose& pose, ThreadPool& pool);

}  // namespace pregrasp
