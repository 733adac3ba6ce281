#pragma once

#include <span>
#include <vector>

#include "app/graph/placement.h"
#include "app/grasp/grasp_world.h"
#include "app/trajectory/simulate_plan.h"

namespace pregrasp {

/// Weights of the terms beside the paper's scores; the scores themselves have weight 1. Every term
/// is zero for a plan that does nothing wrong, and bounded. Two kinds: what a certificate refuses
/// has its weight in the scores' own unit and outweighs what a path can gain; what is only better
/// or worse is a tie-breaker, its weight a share of how far apart the plans' scores are. On flat
/// objects these differ by 0.01 in all, which any absolute weight would swamp. Fragility is
/// neither: a share of what the plan itself gains.
struct CostWeights {
  double room = 1.0;         ///< of GraspRoom at the end, beside the learned score there
  double no_contact = 0.5;   ///< no finger ever touches: doing nothing must never look good
  double slip = 0.25;        ///< tie-breaker: share of the contact time at the cone's limit
  double effort = 0.1;       ///< tie-breaker: mean force over the largest one allowed
  double unrest = 0.3;       ///< tie-breaker: speed when the hold ends, v / (0.1 m/s) + w / (1
                             ///< rad/s), at most 2
  double speed = 0.8;        ///< tie-breaker: peak speed above 0.35 m/s, in m/s, at most 2
  double tip_overlap = 1.0;  ///< deepest overlap of a tip's sphere with the surroundings over a
                             ///< finger's radius, at most 1: such a plan is never certified
  double tip_spacing = 1.0;  ///< the same of the two tips' spheres with each other
  double hold = 1.0;         ///< the object's way in the hold over what a certificate allows, from
                             ///< half of that on, at most 2
  double haste = 2.0;        ///< a tip that touches moves faster than 0.8 m/s or speeds up by more
                             ///< than 8 m/s^2: the larger ratio's excess over 1, at most 1. Hardly
                             ///< a hand follows (HandLimits); where nothing else helps, it may try
  double fragility = 0.33;   ///< what a plan gains over doing nothing, by CalcFragility
  double fall = 1.5;         ///< the object fell out of the scene, or the simulation diverged
};

/// A plan's cost by its terms [dimensionless]; `total` = -`reward` + the others.
struct PlanCost {
  std::vector<double> stage_scores;  ///< at the start of each stage (paper, the objective)
  double final_score = 0.0;          ///< how graspable the object is after the hold
  double room = 0.0;                 ///< GraspRoom there; 0 where none is asked
  double reward = 0.0;               ///< CalcReward of these
  double no_contact = 0.0, slip = 0.0, effort = 0.0, unrest = 0.0, speed = 0.0;
  double tip_overlap = 0.0, tip_spacing = 0.0, hold = 0.0, haste = 0.0, fragility = 0.0, fall = 0.0;
  double total = 0.0;

  /// What compares plans of different paths: without the tie-breakers, whose scale is a path's own.
  double CalcValue() const;
};

/// A penalty's name, what a plan has of it, and its weight: the one table of them, which records,
/// pictures and scripts read.
struct CostTerm {
  const char* name;
  double PlanCost::*value;
  double CostWeights::*weight;
  bool tie_breaker;  ///< weighed by the scale of the path's scores
};
std::span<const CostTerm> CostTerms();

/// How little a plan does elsewhere of what it does here: how far from its end, or how far turned
/// from it, the same targets leave the object in the worlds of `others`, over twice the 2 cm and 10
/// degrees of the design's "robust", at most 1 each, their mean. 1 of what diverged.
double CalcFragility(const PlanOutcome& outcome, std::span<const PlanOutcome> others);

/// What a plan is after: the paper's sum of scores at the stages' starts and at the end, but a
/// start counts at most as much as the end. A plan that swings the object up and drops it is worth
/// what it leaves.
/// @param final_value  the end's worth: its score, and its room by its weight.
double CalcReward(std::span<const double> stage_scores, double final_value);

/// How far apart rewards are: their standard deviation, at least kLeastScoreScale.
double CalcScoreScale(std::span<const double> rewards);
inline constexpr double kLeastScoreScale = 1e-3;  ///< below this the network's noise is larger

/// The states whose scores the cost of `outcome` needs: each stage's start.
std::vector<ScoredState> StatesToScore(const World& world, const PlanOutcome& outcome);

/// The end of `outcome`, for ScoreGraspable: with the contacts that must stay, because the object
/// would not without them.
ScoredState EndToScore(const World& world, const PlanOutcome& outcome);

/// The contacts of `end` that must stay, as a grasp has them.
std::vector<GraspContact> KeptContacts(const ScoredState& end);

/// The cost of a plan from its outcome, the scores of StatesToScore, in order, how graspable the
/// object is at the end, and the room for grasps there; its fragility is 0, for AddFragility.
/// @param force_scale  the largest force that a plan may ask for [N].
/// @param score_scale  what the tie-breakers are weighed by: CalcScoreScale of the path.
PlanCost CalcPlanCost(const World& world, const PlanOutcome& outcome,
                      std::span<const double> stage_scores, double final_score, double room,
                      const CostWeights& weights, double force_scale, double score_scale);

/// Takes the share of a plan's gain over doing nothing that its fragility costs it.
/// @param fragility  CalcFragility, from 0 to 1. @param rest_reward  of doing nothing.
void AddFragility(PlanCost& cost, double fragility, const CostWeights& weights, double rest_reward);

}  // namespace pregrasp
