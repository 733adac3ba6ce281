#include "app/trajectory/certify.h"

#include <cmath>

#include "app/core/check.h"
#include "app/core/finite.h"
#include "app/dynamics/tip_overlap.h"

namespace pregrasp {
namespace {

// What stands in the way; each demand is written so that a NaN does not meet it.
std::vector<CertifyReason> Judge(const PlanOutcome& outcome, const CertifyConfig& config) {
  if (outcome.diverged) return {CertifyReason::kDiverged};
  const bool touches = outcome.contact_seconds > 0.0;
  const bool clear = outcome.max_tip_overlap <= kTipOverlapAllowed;
  const bool holds = StaysInHold(outcome, config);
  const bool apart = outcome.min_tip_gap >= 0.0;
  const bool resolved = outcome.unresolved <= config.max_unresolved;
  std::vector<CertifyReason> reasons;
  if (!touches) reasons.push_back(CertifyReason::kNeverTouches);
  if (!clear) reasons.push_back(CertifyReason::kTipOverlap);
  if (!apart) reasons.push_back(CertifyReason::kTipsTooClose);
  if (!resolved) reasons.push_back(CertifyReason::kNotConverged);
  if (!holds) reasons.push_back(CertifyReason::kDoesNotHold);
  return reasons;
}

// A hold that was simulated: a verdict about one that was not is our bug.
void CheckHold(const PlanOutcome& outcome, double seconds, double dt) {
  if (outcome.diverged) return;
  const double held = outcome.end.t - outcome.hold_start.t;
  PREGRASP_CHECK(std::abs(held - seconds) <= dt, held, seconds);
}

}  // namespace

PlanTiming CertifyTiming(PlanTiming timing, const CertifyConfig& config) {
  timing.hold_seconds = config.hold_seconds;
  timing.stage_seconds *= config.slow;
  timing.transfer_seconds *= config.slow;
  timing.transfer_speed /= config.slow;
  return timing;
}

void CalcShift(const WorldState& a, const WorldState& b, double* shift, double* turn_deg) {
  const RigidTransform X_a = a.bodies.front().X_WB(), X_b = b.bodies.front().X_WB();
  *shift = (X_b.translation() - X_a.translation()).norm();
  *turn_deg = RadToDeg(RotationAngle(X_a.linear(), X_b.linear()));
}

bool StaysInHold(const PlanOutcome& outcome, const CertifyConfig& config) {
  double shift = 0.0, turn_deg = 0.0;
  CalcShift(outcome.hold_start, outcome.end, &shift, &turn_deg);
  return shift < config.max_hold_shift && turn_deg < config.max_hold_turn_deg;
}

const char* CertifyReasonText(CertifyReason reason) {
  switch (reason) {
    case CertifyReason::kDiverged:
      return "the object left the scene";
    case CertifyReason::kTipOverlap:
      return "a fingertip overlaps the surroundings by more than 0.3 mm";
    case CertifyReason::kTipsTooClose:
      return "the fingertips overlap each other";
    case CertifyReason::kDoesNotHold:
      return "the object does not stay where it is while the last targets are kept";
    case CertifyReason::kNeverTouches:
      return "no finger ever touches the object";
    case CertifyReason::kNotConverged:
      return "the simulation did not find the contact forces exactly enough";
    case CertifyReason::kStepDependent:
      return "half the time step gives another verdict";
    case CertifyReason::kOutOfReach:
      return "no pose of the hand was found that has its fingertips at the contacts";
  }
  return "";
}

Certificate CertifyPlan(const World& world, const World& half_world,
                        const EnvironmentDistance& environment, const WorldState& start,
                        const WorldPlan& plan, PlanTiming timing, const CertifyConfig& config) {
  PREGRASP_CHECK(std::abs(half_world.config().dt * 2.0 - world.config().dt) < 1e-12);
  timing = CertifyTiming(timing, config);
  Certificate result;
  result.hold_seconds = config.hold_seconds;
  result.full =
      SimulatePlan(world, environment, start, plan, timing, Stepper::kSimbody, &result.trace);
  result.half = SimulatePlan(half_world, environment, start, plan, timing, Stepper::kSimbody);
  result.neighbours = CalcNeighbourMotion(world, result.full.end);
  CheckHold(result.full, config.hold_seconds, world.config().dt);
  CheckHold(result.half, config.hold_seconds, half_world.config().dt);
  CalcShift(result.full.hold_start, result.full.end, &result.hold_shift, &result.hold_turn_deg);
  CalcShift(result.full.end, result.half.end, &result.step_shift, &result.step_turn_deg);
  PREGRASP_CHECK(
      AreFinite(result.hold_shift, result.hold_turn_deg, result.step_shift, result.step_turn_deg),
      result.hold_shift, result.hold_turn_deg, result.step_shift, result.step_turn_deg);
  result.reasons = Judge(result.full, config);
  const bool half_passes = Judge(result.half, config).empty();
  if (result.reasons.empty() != half_passes) {
    result.reasons.push_back(CertifyReason::kStepDependent);
  }
  result.certified = result.reasons.empty();
  return result;
}

}  // namespace pregrasp
