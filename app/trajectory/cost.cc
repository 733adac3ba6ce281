#include "app/trajectory/cost.h"

#include <algorithm>
#include <cmath>

#include "app/core/check.h"
#include "app/core/finite.h"

namespace pregrasp {
namespace {

constexpr double kRestSpeed = 0.1;   // [m/s] counts as one unit of unrest
constexpr double kRestTurn = 1.0;    // [rad/s] counts as one unit of unrest
constexpr double kFastSpeed = 0.35;  // [m/s]
constexpr double kFallDepth = 0.15;  // [m] below its start: over the edge and gone

ScoredState MakeScoredState(const World& world, const WorldState& state) {
  ScoredState scored;
  scored.X_WB = world.GetPoses(state);
  for (int j = 0; j < kNumPlanningFingers; ++j) {
    const FingertipState& tip = state.fingers[j];
    scored.placement.fingers[j] = {tip.on, tip.p_OC, tip.nhat_O};
  }
  return scored;
}

}  // namespace

std::span<const CostTerm> CostTerms() {
  static constexpr CostTerm kTerms[] = {
      {"no_contact", &PlanCost::no_contact, &CostWeights::no_contact},
      {"slip", &PlanCost::slip, &CostWeights::slip},
      {"effort", &PlanCost::effort, &CostWeights::effort},
      {"unrest", &PlanCost::unrest, &CostWeights::unrest},
      {"speed", &PlanCost::speed, &CostWeights::speed},
      {"tip_overlap", &PlanCost::tip_overlap, &CostWeights::tip_overlap},
      {"tip_spacing", &PlanCost::tip_spacing, &CostWeights::tip_spacing},
      {"fall", &PlanCost::fall, &CostWeights::fall},
  };
  return kTerms;
}

std::vector<ScoredState> StatesToScore(const World& world, const PlanOutcome& outcome) {
  std::vector<ScoredState> states;
  for (const WorldState& state : outcome.stage_starts) {
    states.push_back(MakeScoredState(world, state));
  }
  return states;
}

ScoredState EndToScore(const World& world, const PlanOutcome& outcome) {
  ScoredState end = MakeScoredState(world, outcome.end);
  if (!outcome.diverged && SimulateRelease(world, outcome.end).stays) end.placement = {};
  return end;
}

PlanCost CalcPlanCost(const World& world, const PlanOutcome& outcome,
                      std::span<const double> stage_scores, double final_score,
                      const CostWeights& weights, double force_scale) {
  PREGRASP_CHECK(stage_scores.size() == outcome.stage_starts.size(), stage_scores.size());
  PlanCost cost;
  cost.stage_scores.assign(stage_scores.begin(), stage_scores.end());
  cost.final_score = final_score;
  const bool touched = outcome.contact_seconds > 0.0;
  cost.no_contact = touched ? 0.0 : weights.no_contact;
  if (touched) {
    cost.slip = weights.slip * outcome.slip_seconds / outcome.contact_seconds;
    cost.effort = weights.effort * outcome.effort / (outcome.contact_seconds * force_scale);
  }
  const BodyState& end = outcome.end.bodies.front();
  cost.unrest =
      weights.unrest * std::min(2.0, end.v_WB.norm() / kRestSpeed + end.w_WB.norm() / kRestTurn);
  cost.speed = weights.speed * std::clamp(outcome.max_speed - kFastSpeed, 0.0, 2.0);
  if (outcome.tip_overlap_seconds > 0.0) {
    const double share = std::min(1.0, outcome.tip_overlap_seconds / outcome.seconds);
    cost.tip_overlap = weights.tip_overlap * 0.5 * (1.0 + share);
  }
  const double depth = std::max(0.0, -outcome.min_tip_gap);
  cost.tip_spacing = weights.tip_spacing * std::min(1.0, depth / FingertipRadius(Finger::kIndex));
  const BodyState& start = outcome.stage_starts.front().bodies.front();
  const Vector3 up = -world.scene().gravity.normalized();
  const bool fallen = outcome.diverged || up.dot(end.p_WB - start.p_WB) < -kFallDepth;
  cost.fall = fallen ? weights.fall : 0.0;
  if (outcome.diverged) {  // its numbers mean nothing
    cost.unrest = 2.0 * weights.unrest;
    cost.speed = 2.0 * weights.speed;
  }
  cost.total = -final_score;
  for (const double score : stage_scores) cost.total -= score;
  cost.total += cost.no_contact + cost.slip + cost.effort + cost.unrest + cost.speed +
                cost.tip_overlap + cost.tip_spacing + cost.fall;
  PREGRASP_CHECK(AreFinite(cost.total, cost.stage_scores, final_score), cost.total, final_score);
  return cost;
}

}  // namespace pregrasp
