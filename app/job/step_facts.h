#pragma once

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "app/core/math.h"
#include "app/dynamics/neighbours.h"
#include "app/hand/hand_model.h"
#include "app/job/command.h"
#include "app/scene/finger.h"
#include "app/scene/shape.h"

namespace pregrasp {

// Everything that a picture, a log record, a table, a sentence or a Lua value of a step shows, as
// plain data. Each struct names its fields once, in VisitFields(self, visit), which calls
// visit(name, member) for each: the JSON of steps.jsonl, its reader and the comparison of two runs
// follow from that (facts_json.h). SI units and radians, but where a name says otherwise. Frames as
// everywhere: W world, O object, B body, H palm, C contact.

/// A movable body.
struct BodyFacts {
  std::string name;
  Vector3 p_WB = Vector3::Zero();
  Quaternion q_WB = Quaternion::Identity();
  Vector3 w_WB = Vector3::Zero(), v_WB = Vector3::Zero();

  RigidTransform X_WB() const { return MakeTransform(q_WB, p_WB); }

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("name", self.name);
    visit("p_WB", self.p_WB);
    visit("q_WB", self.q_WB);
    visit("w_WB", self.w_WB);
    visit("v_WB", self.v_WB);
  }
};

/// A finger, as FingertipState.
struct FingerFacts {
  Finger finger = Finger::kThumb;
  bool on = false, touching = false, slipping = false;
  Vector3 p_OC = Vector3::Zero(), nhat_O = Vector3::UnitZ();
  Vector3 p_WF = Vector3::Zero(), p_WTarget = Vector3::Zero();
  Vector3 f_W = Vector3::Zero();  ///< on the object [N]
  double slip = 0.0;              ///< slid over the surface since it was put on [m]

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("finger", self.finger);
    visit("on", self.on);
    visit("touching", self.touching);
    visit("slipping", self.slipping);
    visit("p_OC", self.p_OC);
    visit("nhat_O", self.nhat_O);
    visit("p_WF", self.p_WF);
    visit("p_WTarget", self.p_WTarget);
    visit("f_W", self.f_W);
    visit("slip", self.slip);
  }
};

/// A point where two bodies touch, as ContactPoint.
struct ContactFacts {
  int a = 0, b = 0;  ///< scene indices, a < b
  Vector3 p_W = Vector3::Zero(), nhat_W = Vector3::UnitZ();
  Vector3 f_W = Vector3::Zero();  ///< on b [N]
  double gap = 0.0;               ///< before the step [m]
  Vector3 v_slip_W = Vector3::Zero();

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("a", self.a);
    visit("b", self.b);
    visit("p_W", self.p_W);
    visit("nhat_W", self.nhat_W);
    visit("f_W", self.f_W);
    visit("gap", self.gap);
    visit("v_slip_W", self.v_slip_W);
  }
};

/// A hand at one moment.
struct HandFacts {
  Vector3 p_WH = Vector3::Zero();
  Quaternion q_WH = Quaternion::Identity();
  std::vector<double> joints;  ///< in the order of kHandJointNames

  HandConfiguration configuration() const;

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("p_WH", self.p_WH);
    visit("q_WH", self.q_WH);
    visit("joints", self.joints);
  }
};
HandFacts MakeHandFacts(const HandConfiguration& hand);

/// A fingertip's place on the object.
struct PlaceFacts {
  Finger finger = Finger::kThumb;
  Vector3 p_OC = Vector3::Zero(), nhat_O = Vector3::UnitZ();

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("finger", self.finger);
    visit("p_OC", self.p_OC);
    visit("nhat_O", self.nhat_O);
  }
};

// What single verbs say.

struct OpenFacts {
  std::vector<std::string> departures;  ///< from the physical rules, a sentence each

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("departures", self.departures);
  }
};

struct SettleFacts {
  double seconds = 0.0, moved_mm = 0.0, rotated_deg = 0.0;
  bool at_rest = false;
  std::string body;            ///< that moved furthest
  int not_converged = 0;       ///< physics steps that the contact solver left unfinished
  double unresolved_mm = 0.0;  ///< the overlap that these leave, summed

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("seconds", self.seconds);
    visit("moved_mm", self.moved_mm);
    visit("rotated_deg", self.rotated_deg);
    visit("at_rest", self.at_rest);
    visit("body", self.body);
    visit("not_converged", self.not_converged);
    visit("unresolved_mm", self.unresolved_mm);
  }
};

/// As StartCertificate.
struct VerdictFacts {
  std::string verdict;
  double mu = 0.0;
  std::optional<double> mu_star;  ///< none: the proof holds at the largest friction tried
  bool thin = false;
  int reachable_points = 0, reachable_edge_points = 0;
  int proposed = 0;  ///< grasps of the generator, tested; the rest is of the search
  int drawn = 0, plausible = 0, on_edges = 0, tried = 0, held = 0, reached = 0, feasible = 0;
  std::vector<PlaceFacts> example;  ///< a grasp, if graspable
  std::string sentence;

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("verdict", self.verdict);
    visit("mu", self.mu);
    visit("mu_star", self.mu_star);
    visit("thin", self.thin);
    visit("reachable_points", self.reachable_points);
    visit("reachable_edge_points", self.reachable_edge_points);
    visit("proposed", self.proposed);
    visit("drawn", self.drawn);
    visit("plausible", self.plausible);
    visit("on_edges", self.on_edges);
    visit("tried", self.tried);
    visit("held", self.held);
    visit("reached", self.reached);
    visit("feasible", self.feasible);
    visit("example", self.example);
    visit("sentence", self.sentence);
  }
};

struct MeshFacts {
  int triangles = 0, nodes = 0;
  TriangleMesh mesh;  ///< in O

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("triangles", self.triangles);
    visit("nodes", self.nodes);
    visit("mesh", self.mesh);
  }
};

/// A contact state, as ContactNode.
struct NodeFacts {
  int id = 0, thumb = 0, index = 0;
  double s_c = 0.0, s_n = 0.0;
  int rank_c = 0, rank_n = 0;
  bool thumb_fits = false, index_fits = false;  ///< a tip somewhere on its triangle, at the start

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("id", self.id);
    visit("thumb", self.thumb);
    visit("index", self.index);
    visit("s_c", self.s_c);
    visit("s_n", self.s_n);
    visit("rank_c", self.rank_c);
    visit("rank_n", self.rank_n);
    visit("thumb_fits", self.thumb_fits);
    visit("index_fits", self.index_fits);
  }
};

struct ScoreFacts {
  int samples = 0;               ///< placements of each kind
  std::vector<double> s_c, s_n;  ///< by node
  std::vector<double> occluded;  ///< by node, share of its contacts where no fingertip can be
  NodeFacts best_here, best_alone;

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("samples", self.samples);
    visit("s_c", self.s_c);
    visit("s_n", self.s_n);
    visit("occluded", self.occluded);
    visit("best_here", self.best_here);
    visit("best_alone", self.best_alone);
  }
};

struct PruneFacts {
  std::string cut;           ///< what this step cuts by: "context", "free", or "edges"
  bool complete = false;     ///< the graph is: nothing is left to prune
  int nodes_done = 0;        ///< of the cut under way; 0 where it is done
  double top_percent = 0.0;  ///< the paper's M
  int num_kept_each = 0;     ///< how many nodes the top M percent are
  double threshold_c = 0.0, threshold_n = 0.0;
  int num_tied_c = 0, num_tied_n = 0;  ///< nodes that score exactly that
  int num_edges = 0;
  std::vector<int> initial, kept;  ///< ids of nodes

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("cut", self.cut);
    visit("complete", self.complete);
    visit("nodes_done", self.nodes_done);
    visit("top_percent", self.top_percent);
    visit("num_kept_each", self.num_kept_each);
    visit("threshold_c", self.threshold_c);
    visit("threshold_n", self.threshold_n);
    visit("num_tied_c", self.num_tied_c);
    visit("num_tied_n", self.num_tied_n);
    visit("num_edges", self.num_edges);
    visit("initial", self.initial);
    visit("kept", self.kept);
  }
};

struct PathFacts {
  int rank = 0;
  std::string order;  ///< that it has this rank in: "explore" or "paper"
  std::vector<NodeFacts> nodes;
  double score = 0.0;
  std::vector<double> terms;  ///< its summands
  double value = 0.0;         ///< what the order goes by, as ContactPath
  double repeats = 0.0;       ///< how often paths before it had what it has
  double num_paths = 0.0;     ///< in all
  int num_tied = 1;           ///< with exactly this score, as ContactPath
  std::string tie_rule;       ///< what orders it among these: "", "scores" or "number"
  /// Paths that differ in the last node only and come after this one in the paper's order.
  struct Sibling {
    std::vector<int> nodes;
    double score = 0.0;

    template <typename Self, typename Visit>
    static void VisitFields(Self& self, Visit&& visit) {
      visit("nodes", self.nodes);
      visit("score", self.score);
    }
  };
  std::vector<Sibling> siblings;

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("rank", self.rank);
    visit("order", self.order);
    visit("nodes", self.nodes);
    visit("score", self.score);
    visit("terms", self.terms);
    visit("value", self.value);
    visit("repeats", self.repeats);
    visit("num_paths", self.num_paths);
    visit("num_tied", self.num_tied);
    visit("tie_rule", self.tie_rule);
    visit("siblings", self.siblings);
  }
};

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

/// How far movable bodies other than the object are from where the scene has them.
struct NeighbourFacts {
  std::string worst;  ///< the one that moved most, by name; empty if there are none
  double moved_mm = 0.0, turned_deg = 0.0;  ///< the most of all
  bool disturbed = false;                   ///< one turned over 30 degrees or fell over 5 cm

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("worst", self.worst);
    visit("moved_mm", self.moved_mm);
    visit("turned_deg", self.turned_deg);
    visit("disturbed", self.disturbed);
  }
};
NeighbourFacts MakeNeighbourFacts(const NeighbourMotion& motion, const Scene& scene);

struct CertifyFacts {
  int path = 0;
  int plan = 1;  ///< which of the path's plans, the best first
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

/// A contact of a grasp with the force on the object there.
struct GraspContactFacts {
  Finger finger = Finger::kThumb;
  Vector3 p_OC = Vector3::Zero(), nhat_O = Vector3::UnitZ();
  Vector3 f_O = Vector3::Zero();  ///< [N], in O; zero where no forces were found

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("finger", self.finger);
    visit("p_OC", self.p_OC);
    visit("nhat_O", self.nhat_O);
    visit("f_O", self.f_O);
  }
};

struct GraspFacts {
  int path = 0;
  int entry = 0;       ///< among all grasps of the trajectory, from 1: what lifts and motions name
  int number = 0;      ///< among those of its source, from 1
  std::string source;  ///< "generator" or "search"
  bool feasible = false;
  std::string status, raw_status;
  std::string sentence;  ///< why
  double moved_mm = 0.0;
  int refinements = 0;
  std::vector<GraspContactFacts> contacts;
  std::vector<PlaceFacts> kept;  ///< contacts that press on
  std::optional<double> margin, min_normal_N;
  std::optional<HandFacts> hand;
  std::optional<double> tip_error_mm, clearance_mm;
  std::vector<std::string> colliding;  ///< the closest pair, by name

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("path", self.path);
    visit("entry", self.entry);
    visit("number", self.number);
    visit("source", self.source);
    visit("feasible", self.feasible);
    visit("status", self.status);
    visit("raw_status", self.raw_status);
    visit("sentence", self.sentence);
    visit("moved_mm", self.moved_mm);
    visit("refinements", self.refinements);
    visit("contacts", self.contacts);
    visit("kept", self.kept);
    visit("margin", self.margin);
    visit("min_normal_N", self.min_normal_N);
    visit("hand", self.hand);
    visit("tip_error_mm", self.tip_error_mm);
    visit("clearance_mm", self.clearance_mm);
    visit("colliding", self.colliding);
  }
};

/// As LiftResult.
struct LiftFacts {
  int path = 0, grasp = 0;
  bool held = false;
  std::vector<std::string> reasons;  ///< why not, by name
  std::string sentence;
  double height_m = 0.0, shift_mm = 0.0, turn_deg = 0.0, slip_mm = 0.0;
  Vector3 direction_W = Vector3::UnitZ();
  int pushes = 0;  ///< of six, withstood
  bool soft = false, stiff = false;
  bool forearm_free = false;            ///< at the grasp and at the end
  int not_converged = 0;                ///< physics steps that the contact solver left unfinished
  double unresolved_mm = 0.0;           ///< the overlap that these may have left, summed
  std::vector<GraspContactFacts> grip;  ///< with the forces it holds by
  NeighbourFacts neighbours;            ///< at the end
  double neighbour_moved_mm = 0.0, neighbour_turned_deg = 0.0;  ///< the most, at any step
  HandFacts hand;                                               ///< at the grasp

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("path", self.path);
    visit("grasp", self.grasp);
    visit("held", self.held);
    visit("reasons", self.reasons);
    visit("sentence", self.sentence);
    visit("height_m", self.height_m);
    visit("shift_mm", self.shift_mm);
    visit("turn_deg", self.turn_deg);
    visit("slip_mm", self.slip_mm);
    visit("direction_W", self.direction_W);
    visit("pushes", self.pushes);
    visit("soft", self.soft);
    visit("stiff", self.stiff);
    visit("forearm_free", self.forearm_free);
    visit("not_converged", self.not_converged);
    visit("unresolved_mm", self.unresolved_mm);
    visit("grip", self.grip);
    visit("neighbours", self.neighbours);
    visit("neighbour_moved_mm", self.neighbour_moved_mm);
    visit("neighbour_turned_deg", self.neighbour_turned_deg);
    visit("hand", self.hand);
  }
};

/// A frame of a hand motion, a keyframe or not.
struct FrameFacts {
  int path = 0, grasp = 0;
  int frame = 0;     ///< from 1; of a keyframe's step, before free parts were given their time
  int keyframe = 0;  ///< its number among the keyframes in time, from 1; 0 for none
  std::string phase, loosened;
  bool failed = false;
  bool way_clear = true;  ///< the way from the frame before is free of overlap
  double tip_error_mm = 0.0, clearance_mm = 0.0;
  double simulated_t = 0.0;  ///< of the row of rollout.csv or lift.csv that it shows [s]
  HandFacts hand;
  std::vector<PlaceFacts> touching;

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("path", self.path);
    visit("grasp", self.grasp);
    visit("frame", self.frame);
    visit("keyframe", self.keyframe);
    visit("phase", self.phase);
    visit("loosened", self.loosened);
    visit("failed", self.failed);
    visit("way_clear", self.way_clear);
    visit("tip_error_mm", self.tip_error_mm);
    visit("clearance_mm", self.clearance_mm);
    visit("simulated_t", self.simulated_t);
    visit("hand", self.hand);
    visit("touching", self.touching);
  }
};

/// How fast the hand goes: the largest speeds and accelerations of a phase or of the whole motion.
struct RatesFacts {
  std::string phase;
  double joint_speed = 0.0;                            ///< [rad/s]
  double wrist_speed = 0.0;                            ///< [m/s]
  double wrist_turn_speed = 0.0;                       ///< [rad/s]
  double joint_acceleration = 0.0;                     ///< [rad/s^2]
  double wrist_acceleration = 0.0;                     ///< [m/s^2]
  double wrist_turn_acceleration = 0.0;                ///< [rad/s^2]
  double speed_share = 0.0, acceleration_share = 0.0;  ///< the largest of a limit: 1 reaches it

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("phase", self.phase);
    visit("joint_speed", self.joint_speed);
    visit("wrist_speed", self.wrist_speed);
    visit("wrist_turn_speed", self.wrist_turn_speed);
    visit("joint_acceleration", self.joint_acceleration);
    visit("wrist_acceleration", self.wrist_acceleration);
    visit("wrist_turn_acceleration", self.wrist_turn_acceleration);
    visit("speed_share", self.speed_share);
    visit("acceleration_share", self.acceleration_share);
  }
};

/// A motion after its in-betweens or its smoothing.
struct MotionFacts {
  int path = 0, grasp = 0;
  int frames = 0, failed = 0, loosened = 0;
  int blocked_ways = 0;  ///< of the failed frames, those that the way to goes through something
  double seconds = 0.0;  ///< of the animation
  double max_tip_error_mm = 0.0, min_clearance_mm = 0.0;
  bool forearm_free = false;  ///< of all bodies, in every frame
  int over_limits = 0;        ///< frames at which the hand exceeds a limit of speed or acceleration
  RatesFacts rates;
  std::vector<RatesFacts> phases;
  std::vector<std::string> ways;  ///< of the free parts, in time: how each was found
  std::string order;

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("path", self.path);
    visit("grasp", self.grasp);
    visit("frames", self.frames);
    visit("failed", self.failed);
    visit("loosened", self.loosened);
    visit("blocked_ways", self.blocked_ways);
    visit("seconds", self.seconds);
    visit("max_tip_error_mm", self.max_tip_error_mm);
    visit("min_clearance_mm", self.min_clearance_mm);
    visit("forearm_free", self.forearm_free);
    visit("over_limits", self.over_limits);
    visit("rates", self.rates);
    visit("phases", self.phases);
    visit("ways", self.ways);
    visit("order", self.order);
  }
};

/// An action on a simulation by hand.
struct SimulationFacts {
  int physics_steps = 0;  ///< of this action
  bool stopped = false;   ///< ended before its time
  double moved_mm = 0.0, rotated_deg = 0.0;
  struct Trace {
    double max_penetration = 0.0, kinetic_energy = 0.0, potential_energy = 0.0;

    template <typename Self, typename Visit>
    static void VisitFields(Self& self, Visit&& visit) {
      visit("max_penetration", self.max_penetration);
      visit("kinetic_energy", self.kinetic_energy);
      visit("potential_energy", self.potential_energy);
    }
  };
  std::optional<Trace> trace;  ///< of the last physics step, where asked for

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("physics_steps", self.physics_steps);
    visit("stopped", self.stopped);
    visit("moved_mm", self.moved_mm);
    visit("rotated_deg", self.rotated_deg);
    visit("trace", self.trace);
  }
};

/// One alternative for each kind of step; which one follows from the command's verb.
using StepDetails = std::variant<OpenFacts, SettleFacts, VerdictFacts, MeshFacts, ScoreFacts,
                                 PruneFacts, PathFacts, ScreenFacts, IterationFacts, CertifyFacts,
                                 GraspFacts, LiftFacts, FrameFacts, MotionFacts, SimulationFacts>;

/// One step: the unit of steps.jsonl, of run.rawlog and of the pictures, all under one id.
struct StepFacts {                // NOLINT(bugprone-exception-escape): moving JSON does not throw
  std::string id;                 ///< unique in a job
  Command command;                ///< what made it, and from which step
  double t = 0.0;                 ///< simulated time [s]
  std::vector<BodyFacts> bodies;  ///< the movable ones, the object first
  std::vector<FingerFacts> fingers;  ///< all five
  std::vector<ContactFacts> contacts;
  StepDetails details;

  /// "scene", "graph", "paths", "path", "motion" or "sim": the first word of the id.
  std::string stage() const { return id.substr(0, id.find('.')); }
  const BodyFacts& object() const { return bodies.front(); }
};

/// The details that a step of `verb` has, empty.
StepDetails MakeDetails(Verb verb);

/// Finds the facts of an earlier step by its id. @throws InputError if there is none.
class FactsSource {
 public:
  virtual ~FactsSource() = default;
  virtual const StepFacts& Get(const std::string& id) const = 0;

  /// The nearest step with details of type T among `step` and the steps that led to it; null if
  /// none.
  template <typename T>
  const T* FindBefore(const StepFacts& step) const {
    const StepFacts* at = &step;
    while (true) {
      if (const T* found = std::get_if<T>(&at->details)) return found;
      if (at->command.node.empty()) return nullptr;
      at = &Get(at->command.node);
    }
  }
};

}  // namespace pregrasp
