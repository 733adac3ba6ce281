#pragma once

#include <vector>

#include "app/dynamics/world.h"
#include "app/geometry/signed_distance.h"
#include "app/trajectory/plan.h"

namespace pregrasp {

inline constexpr double kTipWindow = 1.0 / 60.0;  ///< [s]

/// What a simulated plan did: everything that its cost and its verdict are made from.
struct PlanOutcome {
  WorldPlan plan;                        ///< with the targets that were used
  std::vector<double> waits;             ///< before each stage, until its fingers can be there [s]
  std::vector<WorldState> stage_starts;  ///< the state when each stage begins, its fingers put on
  /// After the hold; where the state is not finite any more, the last stage's start.
  WorldState end;
  WorldState hold_start;  ///< when the last target is reached

  double seconds = 0.0;          ///< simulated, hold included
  double contact_seconds = 0.0;  ///< summed over fingers, while touching
  double slip_seconds = 0.0;     ///< of these, at the cone's limit
  double effort = 0.0;           ///< integral of the summed |f| over time [N s]
  double max_force = 0.0;        ///< [N]
  double max_speed = 0.0;        ///< of the object's origin [m/s]
  /// Of the fingertips while they touch, over kTipWindow: how fast, and how abruptly, the hand
  /// would have to follow.
  double max_tip_speed = 0.0;         ///< [m/s]
  double max_tip_acceleration = 0.0;  ///< [m/s^2]
  double max_penetration = 0.0;       ///< between bodies [m]; by Stepper::kSimbody only
  double max_tip_overlap = 0.0;       ///< deepest overlap of a fingertip sphere with the
                                      ///< surroundings [m]
  double tip_overlap_seconds = 0.0;   ///< time with more than kTipOverlapAllowed
  double min_tip_gap = 1e9;           ///< between the two fingertip spheres while both are on [m]
  int not_converged = 0;              ///< steps that the contact solver left unfinished
  double max_residual = 0.0;          ///< the fastest approach that such a step left [m/s]
  double unresolved = 0.0;            ///< the way of these approaches, summed over the steps [m]
  /// The object left the scene, or the state was no longer finite: what is kept is then the last
  /// state known to be finite.
  bool diverged = false;
};

/// What happens to the object when all fingers let go.
struct Released {
  double shift = 0.0;     ///< of its origin in 1 s [m]
  double turn_deg = 0.0;  ///< [degrees]
  /// Under 1 cm and 5 degrees (design, section 4): no finger has to keep pressing.
  bool stays = false;
};
Released SimulateRelease(const World& world, WorldState state);

/// Simulates a relative plan from `start` through its stages and the hold. A finger whose tip does
/// not fit where it is to be put stays away, in the stages that keep it too: the outcome's plan
/// says so.
/// @param trace  filled with one row a step if given, the start first, with what touches there.
PlanOutcome SimulatePlan(const World& world, const EnvironmentDistance& environment,
                         const WorldState& start, const RelativePlan& plan,
                         const PlanTiming& timing, std::vector<TraceRow>* trace = nullptr);

/// Simulates a plan whose targets are given in the world, by either stepper. A plan that ends
/// before its stages do, as one that was simulated until it diverged, diverges there.
/// @param trace  as above.
PlanOutcome SimulatePlan(const World& world, const EnvironmentDistance& environment,
                         const WorldState& start, const WorldPlan& plan, const PlanTiming& timing,
                         Stepper stepper, std::vector<TraceRow>* trace = nullptr);

}  // namespace pregrasp
