#pragma once

#include <cstdint>
#include <vector>

#include "app/dynamics/world.h"
#include "app/grasp/grasp_room.h"
#include "app/grasp/grasp_world.h"
#include "app/trajectory/plan.h"

namespace pregrasp {

/// How an object's states are gathered along simulated motions.
struct MotionStatesConfig {
  int pushes = 96;  ///< simulated
  int states = 6;   ///< kept at most, the start among them
  /// Short: states are wanted from the middle of motions too, not only from where these end.
  PlanTiming timing{.stage_seconds = 0.8, .knots = 4, .hold_seconds = 0.3};
};

/// A moment at which the object is at rest, or nearly.
struct ReachedState {
  WorldState state;
  /// Contacts of thumb and index finger without which the object would not stay; empty where it
  /// stays by itself. Fingers of `state` that are not among them are off.
  std::vector<GraspContact> fixed;
  bool moved = false;  ///< not the start
};

/// States that pushes lead to, the start first: thumb, index finger or both put where their tips
/// fit, sliding, tilting, lifting or pinching the object with random forces, by the project's own
/// simulation; half of the pushes begin where an earlier one left the object by itself, rather
/// where it has room. Of all ends, those are kept that have the most room for grasps and those that
/// differ most, held ones and others in turn. Left out are ends where the object has fallen, still
/// moves, or rests on a finger that overlaps the surroundings.
/// @param seed  keys every draw.
std::vector<ReachedState> SampleMotionStates(const World& world, const GraspWorld& grasp_world,
                                             const GraspRoom& room,
                                             const MotionStatesConfig& config, std::uint64_t seed);

}  // namespace pregrasp
