#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/job/scene_facts.h"

namespace pregrasp {

// As in step_facts.h: screening, MPPI and certification.

/// A term of a plan's cost: the table of them is in app/trajectory/cost.h.
struct CostTermFacts {
  std::string name;
  double value = 0.0;

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("name", self.name);
    visit("value", self.value);
  }
};

struct CostFacts {
  double total = 0.0;
  std::vector<double> stage_scores;
  double final_score = 0.0;
  double room = 0.0;                 ///< for grasps at the end, as GraspRoom
  double reward = 0.0;               ///< what these count together
  std::vector<CostTermFacts> terms;  ///< penalties, all of them

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("total", self.total);
    visit("stage_scores", self.stage_scores);
    visit("final_score", self.final_score);
    visit("room", self.room);
    visit("reward", self.reward);
    visit("terms", self.terms);
  }
};

/// What one finger does in one contact stage of a plan.
struct StageFingerFacts {
  Finger finger = Finger::kThumb;
  bool on = false, kept = false;
  int triangle = 0;  ///< where it may touch
  Vector3 p_OC = Vector3::Zero(), nhat_O = Vector3::UnitZ();
  std::vector<Vector3> p_WTargets;  ///< at the end of each knot; of certified plans only

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("finger", self.finger);
    visit("on", self.on);
    visit("kept", self.kept);
    visit("triangle", self.triangle);
    visit("p_OC", self.p_OC);
    visit("nhat_O", self.nhat_O);
    visit("p_WTargets", self.p_WTargets);
  }
};
using StageFacts = std::vector<StageFingerFacts>;

struct RolloutFacts {
  CostFacts cost;
  double weight = 0.0;  ///< in the new mean
  std::vector<StageFacts> stages;
  Vector3 p_WO_end = Vector3::Zero();
  Quaternion q_WO_end = Quaternion::Identity();

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("cost", self.cost);
    visit("weight", self.weight);
    visit("stages", self.stages);
    visit("p_WO_end", self.p_WO_end);
    visit("q_WO_end", self.q_WO_end);
  }
};

/// A round of screening: what a path seems to be worth.
struct ScreenFacts {
  int path = 0;  ///< its rank
  int round = 0;
  int iterations = 0, rollouts = 0;  ///< of this round
  /// Of the best plan so far: its reward less what a certificate refuses, without tie-breakers, so
  /// that paths compare; and what doing nothing is worth.
  double value = 0.0, rest_reward = 0.0;
  double score_scale = 0.0;
  CostFacts best;
  std::vector<StageFacts> stages;  ///< of the best plan

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("path", self.path);
    visit("round", self.round);
    visit("iterations", self.iterations);
    visit("rollouts", self.rollouts);
    visit("value", self.value);
    visit("rest_reward", self.rest_reward);
    visit("score_scale", self.score_scale);
    visit("best", self.best);
    visit("stages", self.stages);
  }
};

struct IterationFacts {
  int path = 0;  ///< its rank
  int iteration = 0, limit = 0;
  double sigma = 0.0;        ///< of this iteration's noise
  double score_scale = 0.0;  ///< what tie-breaking terms are weighed by, on all of this path
  double rest_reward = 0.0;  ///< what doing nothing is worth
  bool risen = false;        ///< a plan was worth more than that: patience counts from then on
  int num_plans = 0;         ///< whose ends differ, kept to choose from
  double best_cost = 0.0, mean_cost = 0.0;
  CostFacts best;          ///< of all iterations
  bool converged = false;  ///< it ended by patience
  std::string end;         ///< why it ended: "", "patience" or "limit"
  std::vector<RolloutFacts> rollouts;

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("path", self.path);
    visit("iteration", self.iteration);
    visit("limit", self.limit);
    visit("sigma", self.sigma);
    visit("score_scale", self.score_scale);
    visit("rest_reward", self.rest_reward);
    visit("risen", self.risen);
    visit("num_plans", self.num_plans);
    visit("best_cost", self.best_cost);
    visit("mean_cost", self.mean_cost);
    visit("best", self.best);
    visit("converged", self.converged);
    visit("end", self.end);
    visit("rollouts", self.rollouts);
  }
};

/// As RobustResult: how a certified plan ends in changed worlds.
struct RobustFacts {
  int worlds = 0, held = 0;
  double worst_shift_mm = 0.0, worst_turn_deg = 0.0;
  std::vector<std::string> elsewhere;  ///< the changes with which it does not hold

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("worlds", self.worlds);
    visit("held", self.held);
    visit("worst_shift_mm", self.worst_shift_mm);
    visit("worst_turn_deg", self.worst_turn_deg);
    visit("elsewhere", self.elsewhere);
  }
};

struct CertifyFacts {
  int path = 0;
  int plan = 1;  ///< which of the path's plans, the best first; 0 for one made by hand
  bool certified = false;
  std::vector<std::string> reasons;
  double slow = 1.0;  ///< times as long as planned
  double hold_seconds = 0.0;
  double hold_shift_mm = 0.0, hold_turn_deg = 0.0;
  double step_shift_mm = 0.0, step_turn_deg = 0.0;  ///< at half the time step, elsewhere by
  double released_shift_mm = 0.0, released_turn_deg = 0.0;
  bool stays_when_released = false;
  double seconds = 0.0;
  double max_speed = 0.0, max_force_N = 0.0, max_penetration_mm = 0.0, max_tip_overlap_mm = 0.0;
  int not_converged = 0;                 ///< physics steps that the contact solver left unfinished
  double unresolved_mm = 0.0;            ///< the overlap that such steps leave, summed; at half the
                                         ///< step where that leaves more
  std::optional<RobustFacts> robust;     ///< of certified plans
  NeighbourFacts neighbours;             ///< at the end of the hold
  std::optional<double> out_of_reach_t;  ///< [s]
  std::vector<PlaceFacts> pressing;
  std::vector<double> waits;  ///< before each stage, for the hand to get there [s]
  std::vector<StageFacts> stages;

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("path", self.path);
    visit("plan", self.plan);
    visit("certified", self.certified);
    visit("reasons", self.reasons);
    visit("slow", self.slow);
    visit("hold_seconds", self.hold_seconds);
    visit("hold_shift_mm", self.hold_shift_mm);
    visit("hold_turn_deg", self.hold_turn_deg);
    visit("step_shift_mm", self.step_shift_mm);
    visit("step_turn_deg", self.step_turn_deg);
    visit("released_shift_mm", self.released_shift_mm);
    visit("released_turn_deg", self.released_turn_deg);
    visit("stays_when_released", self.stays_when_released);
    visit("seconds", self.seconds);
    visit("max_speed", self.max_speed);
    visit("max_force_N", self.max_force_N);
    visit("max_penetration_mm", self.max_penetration_mm);
    visit("max_tip_overlap_mm", self.max_tip_overlap_mm);
    visit("not_converged", self.not_converged);
    visit("unresolved_mm", self.unresolved_mm);
    visit("robust", self.robust);
    visit("neighbours", self.neighbours);
    visit("out_of_reach_t", self.out_of_reach_t);
    visit("pressing", self.pressing);
    visit("waits", self.waits);
    visit("stages", self.stages);
  }
};

}  // namespace pregrasp
