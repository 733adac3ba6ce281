#pragma once

#include <array>
#include <optional>
#include <vector>

#include "app/hand/ik.h"
#include "app/trajectory/simulate_plan.h"

namespace pregrasp {

/// Contacts on the object at one moment, by finger.
using Contacts = std::array<Placement::Contact, kNumFingers>;

bool AnyOn(const Contacts& contacts);

/// Of the fingers that are on.
Contacts ContactsOn(const WorldState& state);

/// The contacts along a trajectory, by row: of the fingers that touch. One that is on without
/// touching has no place on the object, and the hand need not be there; unless it has been put on
/// or has touched in the last tenth of a second, and touches again within it.
std::vector<Contacts> FindTouches(const std::vector<TraceRow>& trace);

/// The first moment of a trajectory at which no pose of the hand was found that has its fingertips
/// at the contacts, with all that a motion's frame may give up given up (LooseningRung); nothing
/// where there is one at the start and the end of every contact, and in between at least every
/// quarter of a second. So it refuses only what no hand motion can follow.
/// @param ik   what a frame asks for, strictly.
/// @param rng  keyed by what the trajectory is for.
/// @returns the time of the moment [s].
std::optional<double> FindOutOfReach(const IkSolver& solver, const IkConfig& ik, const World& world,
                                     const std::vector<TraceRow>& trace, const Rng& rng);

}  // namespace pregrasp
