#pragma once

#include <optional>
#include <vector>

#include "app/dynamics/neighbours.h"
#include "app/trajectory/simulate_plan.h"

namespace pregrasp {

/// What the object must keep in the hold; a NaN among them certifies nothing.
struct CertifyConfig {
  double slow = 1.0;               ///< stages and transfers take this many times as long as planned
  double hold_seconds = 1.5;       ///< the last targets are kept this long (design, section 4)
  double max_hold_shift = 0.01;    ///< the object may move this far in the hold [m]
  double max_hold_turn_deg = 5.0;  ///< and turn this far [degrees]
  /// Bodies may have come this far into each other by what the contact solver left unfinished, over
  /// all steps and as if nothing had pushed them out again [m]: a tenth of max_hold_shift.
  double max_unresolved = 0.001;
};

/// Why a plan is not certified.
enum class CertifyReason {
  kDiverged,      ///< the object left the scene
  kTipOverlap,    ///< a fingertip sphere overlaps the surroundings by more than 0.3 mm at some step
  kTipsTooClose,  ///< the two fingertip spheres overlap at some step
  kDoesNotHold,   ///< the object moves on in the hold
  kNeverTouches,  ///< no finger ever touches the object
  kNotConverged,  ///< contact forces were not found to the accuracy that a verdict needs
  kStepDependent,  ///< half the time step gives another verdict
  kOutOfReach,     ///< no pose of the hand was found for the contacts of some moment
};
const char* CertifyReasonText(CertifyReason reason);

/// A plan simulated through the full Simbody model, and again at half the step.
struct Certificate {
  bool certified = false;
  std::vector<CertifyReason> reasons;  ///< empty if certified
  PlanOutcome full, half;
  double hold_seconds = 0.0;             ///< how long the last targets were kept [s]
  double hold_shift = 0.0;               ///< the object's way in that time [m], at the full step
  double hold_turn_deg = 0.0;            ///< [degrees]
  double step_shift = 0.0;               ///< distance between the two final positions [m]
  double step_turn_deg = 0.0;            ///< and orientations [degrees]
  NeighbourMotion neighbours;            ///< at the end of the hold, at the full step
  std::optional<double> out_of_reach_t;  ///< when the hand was found to have no pose [s]
  std::vector<TraceRow> trace;           ///< every step at the full step, the start first
};

/// In which a plan that was made with `timing` is certified.
PlanTiming CertifyTiming(PlanTiming timing, const CertifyConfig& config);

/// How far the object is in `b` from where it is in `a` [m], and how far turned [degrees].
void CalcShift(const WorldState& a, const WorldState& b, double* shift, double* turn_deg);

/// Whether the object stays where it is while the last targets are kept, within the config's
/// bounds.
bool StaysInHold(const PlanOutcome& outcome, const CertifyConfig& config);

/// Certifies the world plan `plan` (honesty rules 4 and 5).
/// @param half_world  the same scene at half the step.
/// Whether the hand reaches its contacts is not among the questions here (Planner::Certify).
Certificate CertifyPlan(const World& world, const World& half_world,
                        const EnvironmentDistance& environment, const WorldState& start,
                        const WorldPlan& plan, PlanTiming timing, const CertifyConfig& config);

}  // namespace pregrasp
