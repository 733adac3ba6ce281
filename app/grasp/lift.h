#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/grasp/feasible_grasp.h"
#include "app/grasp/lift_simulation.h"

namespace pregrasp {

/// The design's "lift" of a feasible grasp: whether the hand picks the object up, and what the
/// grasp withstands at the top. Of the simulation at the full step, through Simbody.
struct LiftResult : LiftOutcome {
  bool held = false;
  std::vector<LiftReason> reasons;  ///< empty if held
  LiftWay way;
  LiftGrip grip;
  /// What the forces were chosen by; absent if the way is not free or nothing balances the weight.
  std::optional<GraspForces> forces;
  bool simulated = false;  ///< otherwise the outcome is that of no step

  /// Whether the forearm behind the hand is clear of all bodies (Forearm), at the grasp and at the
  /// end of the lift.
  bool forearm_free = false;
  /// Of the six pushes of half the object's weight along +-x, +-y, +-z of the object for 0.3 s,
  /// those that it withstands: half a second later it is within 1 cm and 15 degrees of where it
  /// was, and fingers alone hold it. 0 unless held.
  int pushes = 0;
  /// Whether the whole lift, forces and all, holds with fingers of 150 and of 600 N/m. False unless
  /// held.
  bool soft = false, stiff = false;
};

inline constexpr double kSoftStiffness = 150.0, kStiffStiffness = 600.0;  // [N/m]
inline constexpr int kNumPushes = 6;

/// The worlds of a lift: the same scene at the full step and at half of it.
struct LiftWorlds {
  const World& full;
  const World& half;
  const GraspWorld& grasp;
};

/// Lifts a feasible grasp from `state`, the certified end, in which some fingers may press
/// already. In turn, the first that fails is the reason: the way; forces for the grasp to hold with
/// (ChooseGraspForces) at which its stiffness is positive definite with a margin; the simulation;
/// the same at half the step.
/// @param way  FindLiftWay of the state, the same for all grasps.
LiftResult LiftGrasp(const LiftWorlds& worlds, const WorldState& state, const GraspResult& grasp,
                     const LiftWay& way, const LiftConfig& config);

/// Whether `a` is to be preferred: it holds; no neighbour is disturbed; it withstands more
/// pushes; more of soft and stiff.
/// False where they are alike.
bool WithstandsMore(const LiftResult& a, const LiftResult& b);

/// One sentence for a person: what it withstands, or what stands in the way.
std::string Explain(const LiftResult& lift, const Scene& scene);

}  // namespace pregrasp
