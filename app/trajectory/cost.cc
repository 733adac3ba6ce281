#include "app/trajectory/cost.h"

#include <algorithm>
#include <cmath>

#include "app/core/check.h"
#include "app/core/finite.h"
#include "app/trajectory/certify.h"
#include "app/trajectory/robust.h"

namespace pregrasp {
namespace {

constexpr double kRestSpeed = 0.1;   // [m/s] counts as one unit of unrest
constexpr double kRestTurn = 1.0;    // [rad/s] counts as one unit of unrest
constexpr double kFastSpeed = 0.35;  // [m/s]
constexpr double kTipSpeed = 0.8;    // [m/s] of a fingertip, nearly what the wrist may do
constexpr double kTipHaste = 8.0;    // [m/s^2] a way of a frame bends by a millimetre
constexpr double kDeep = 0.009;      // [m] of an overlap that counts as one: a fingertip
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
      {"no_contact", &PlanCost::no_contact, &CostWeights::no_contact, false},
      {"slip", &PlanCost::slip, &CostWeights::slip, true},
      {"effort", &PlanCost::effort, &CostWeights::effort, true},
      {"unrest", &PlanCost::unrest, &CostWeights::unrest, true},
      {"speed", &PlanCost::speed, &CostWeights::speed, true},
      {"tip_overlap", &PlanCost::tip_overlap, &CostWeights::tip_overlap, false},
      {"tip_spacing", &PlanCost::tip_spacing, &CostWeights::tip_spacing, false},
      {"hold", &PlanCost::hold, &CostWeights::hold, false},
      {"haste", &PlanCost::haste, &CostWeights::haste, false},
      {"fragility", &PlanCost::fragility, &CostWeights::fragility, false},
      {"fall", &PlanCost::fall, &CostWeights::fall, false},
  };
  return kTerms;
}

double CalcFragility(const PlanOutcome& outcome, std::span<const PlanOutcome> others) {
  if (outcome.diverged) return 1.0;
  double sum = 0.0;
  for (const PlanOutcome& other : others) {
    double shift = 0.0, turn_deg = 0.0;
    CalcShift(outcome.end, other.end, &shift, &turn_deg);
    const double away = std::max(shift / kRobustShift, turn_deg / kRobustTurnDeg);
    sum += other.diverged ? 1.0 : std::min(0.5 * away, 1.0);
  }
  return others.empty() ? 0.0 : sum / static_cast<double>(others.size());
}

double CalcReward(std::span<const double> stage_scores, double final_value) {
  double reward = final_value;
  for (const double score : stage_scores) reward += std::min(score, final_value);
  return reward;
}

double PlanCost::CalcValue() const {
  double value = reward;
  for (const CostTerm& term : CostTerms()) {
    if (!term.tie_breaker) value -= this->*term.value;
  }
  return value;
}

std::vector<GraspContact> KeptContacts(const ScoredState& end) {
  std::vector<GraspContact> kept;
  for (int j = 0; j < kNumPlanningFingers; ++j) {
    const Placement::Contact& contact = end.placement.fingers[j];
    if (contact.on) kept.push_back({static_cast<Finger>(j), contact.p_OC, contact.nhat_O});
  }
  return kept;
}

double CalcScoreScale(std::span<const double> rewards) {
  PREGRASP_CHECK(!rewards.empty());
  const auto count = static_cast<double>(rewards.size());
  double mean = 0.0, variance = 0.0;
  for (const double reward : rewards) mean += reward / count;
  for (const double reward : rewards) variance += (reward - mean) * (reward - mean) / count;
  return std::max(kLeastScoreScale, std::sqrt(variance));
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
                      std::span<const double> stage_scores, double final_score, double room,
                      const CostWeights& weights, double force_scale, double score_scale) {
  PREGRASP_CHECK(stage_scores.size() == outcome.stage_starts.size(), stage_scores.size());
  PREGRASP_CHECK(score_scale > 0.0, score_scale);
  PlanCost cost;
  cost.stage_scores.assign(stage_scores.begin(), stage_scores.end());
  cost.final_score = final_score;
  cost.room = room;
  cost.reward = CalcReward(stage_scores, final_score + weights.room * room);
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
  const auto by_radius = [](double depth) { return std::clamp(depth / kDeep, 0.0, 1.0); };
  cost.tip_overlap = weights.tip_overlap * by_radius(outcome.max_tip_overlap);
  cost.tip_spacing = weights.tip_spacing * by_radius(-outcome.min_tip_gap);
  double shift = 0.0, turn_deg = 0.0;
  CalcShift(outcome.hold_start, outcome.end, &shift, &turn_deg);
  const CertifyConfig allowed;
  const double moved =
      std::max(shift / allowed.max_hold_shift, turn_deg / allowed.max_hold_turn_deg);
  cost.hold = weights.hold * std::clamp(moved - 0.5, 0.0, 2.0);
  const double haste =
      std::max(outcome.max_tip_speed / kTipSpeed, outcome.max_tip_acceleration / kTipHaste);
  cost.haste = weights.haste * std::clamp(haste - 1.0, 0.0, 1.0);
  const BodyState& start = outcome.stage_starts.front().bodies.front();
  const Vector3 up = -world.scene().gravity.normalized();
  const bool fallen = outcome.diverged || up.dot(end.p_WB - start.p_WB) < -kFallDepth;
  cost.fall = fallen ? weights.fall : 0.0;
  if (outcome.diverged) {  // its numbers mean nothing
    cost.unrest = 2.0 * weights.unrest;
    cost.speed = 2.0 * weights.speed;
    cost.hold = 2.0 * weights.hold;
  }
  cost.total = -cost.reward;
  for (const CostTerm& term : CostTerms()) {
    if (term.tie_breaker) cost.*term.value *= score_scale;
    cost.total += cost.*term.value;
  }
  PREGRASP_CHECK(AreFinite(cost.total, cost.stage_scores, final_score), cost.total, final_score);
  return cost;
}

void AddFragility(PlanCost& cost, double fragility, const CostWeights& weights,
                  double rest_reward) {
  PREGRASP_CHECK(fragility >= 0.0 && fragility <= 1.0, fragility);
  cost.total -= cost.fragility;
  cost.fragility = weights.fragility * fragility * std::max(cost.reward - rest_reward, 0.0);
  cost.total += cost.fragility;
}

}  // namespace pregrasp
