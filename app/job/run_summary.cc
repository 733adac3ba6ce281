#include "app/job/run_summary.h"

#include <algorithm>
#include <set>

#include "app/job/motion_measure.h"
#include "app/job/planner_settings.h"

namespace pregrasp {
namespace {

using Node = Timeline::Node;

template <typename T>
const T* Details(const Node& node) {
  return std::get_if<T>(&node.facts.details);
}

// The latest node on the way to `node` whose details are T; null if there is none.
template <typename T>
const Node* FindOnTheWay(const Node& node) {
  for (const Node* at = &node; at != nullptr; at = at->parent) {
    if (Details<T>(*at) != nullptr) return at;
  }
  return nullptr;
}

const VerdictFacts* FindVerdict(const Timeline& timeline) {
  for (const auto& node : timeline.nodes()) {
    if (const auto* verdict = Details<VerdictFacts>(*node)) return verdict;
  }
  return nullptr;
}

// What decides that a stage's verdict is final.
bool AllGraspsTried(const JobState& state) {
  if (state.release->conditions.empty()) return true;  // there are none to try
  return state.grasps && state.num_grasps == static_cast<int>(state.grasps->grasps.size());
}

bool AllFeasibleLifted(const JobState& state) {
  for (int number = 1; number <= state.num_grasps; ++number) {
    if (state.grasps->grasps[number - 1].feasible() && state.lifts.count(number) == 0) return false;
  }
  return true;
}

bool IsMotionDecided(const JobState& state) {
  return state.motion && (state.motion_state->finished || state.motion_state->is_hopeless());
}

void FillTrajectory(const JobState& state, const Node& node, RunSummary& summary) {
  const Node* certified = FindOnTheWay<CertifyFacts>(node);
  if (certified == nullptr) {
    if (!state.simulation && state.graph) return;
    summary.physics.max_penetration_mm =
        state.simulation ? 1e3 * state.simulation->CalcMaxPenetration() : 0.0;
    return;
  }
  const auto& facts = std::get<CertifyFacts>(certified->facts.details);
  summary.physics.max_penetration_mm = facts.max_penetration_mm;
  if (facts.robust) {
    summary.robust.worlds = facts.robust->worlds;
    summary.robust.held = facts.robust->held;
    summary.robust.worst_shift_mm = facts.robust->worst_shift_mm;
    summary.robust.worst_turn_deg = facts.robust->worst_turn_deg;
  }
  summary.contacts.emplace();
  int switches = 0;
  for (std::size_t i = 0; i < facts.stages.size(); ++i) {
    RunSummary::Stage stage;
    for (std::size_t f = 0; f < facts.stages[i].size(); ++f) {
      const StageFingerFacts& finger = facts.stages[i][f];
      if (finger.on) {
        stage.fingers.push_back(finger.finger);
        stage.triangles.push_back(finger.triangle);
      }
      if (i == 0) continue;
      const bool before = facts.stages[i - 1][f].on;
      switches += before != finger.on || (finger.on && !finger.kept) ? 1 : 0;
    }
    summary.contacts->push_back(std::move(stage));
  }
  summary.switches = switches;
}

void FillGrasps(const JobState& state, RunSummary& summary) {
  if (!state.grasps || state.num_grasps == 0) return;
  summary.r_suc = state.grasps->r_suc();
  summary.r_suc_raw = state.grasps->r_suc_raw();
  // The generator's samples count alone; a grasp that the search found is marked by its source.
  summary.grasps.tried = state.grasps->count(GraspSource::kGenerator);
  summary.grasps.feasible = state.grasps->count_feasible(GraspSource::kGenerator);
  int lifting = 0;
  for (const auto& [entry, lift] : state.lifts) {
    const bool generated = state.grasps->grasps[entry - 1].source == GraspSource::kGenerator;
    lifting += generated && lift->held ? 1 : 0;
  }
  summary.grasps.lifting = lifting;
  summary.r_lift =
      *summary.grasps.tried == 0 ? 0.0 : static_cast<double>(lifting) / *summary.grasps.tried;
  summary.grasps.kept.emplace();
  if (!state.release->stays) {
    for (const GraspContact& contact : state.release->pressing) {
      summary.grasps.kept->push_back(contact.finger);
    }
  }
}

void FillChosen(const Timeline& timeline, const JobState& state, RunSummary& summary) {
  if (state.chosen_grasp == 0) return;
  const CompletedGrasp& grasp = state.grasps->grasps[state.chosen_grasp - 1];
  const RigidTransform X_WO = state.certificate->full.end.bodies.front().X_WB();
  const WrenchResult& wrench = *grasp.result.wrench;
  summary.grasps.source = GraspSourceName(grasp.source);
  summary.grasps.fingers.emplace();
  summary.wrench.mu = timeline.job().scene().fingertips.friction;
  summary.wrench.margin = wrench.margin;
  summary.wrench.min_normal_N = wrench.min_normal;
  summary.wrench.forces.emplace();
  for (std::size_t i = 0; i < grasp.result.contacts.size(); ++i) {
    const GraspContact& contact = grasp.result.contacts[i];
    const Vector3 f_O = wrench.forces.row(static_cast<Eigen::Index>(i)).transpose();
    summary.grasps.fingers->push_back(contact.finger);
    summary.wrench.forces->push_back(
        {contact.finger, X_WO * contact.p_OC, X_WO.linear() * contact.nhat_O, X_WO.linear() * f_O});
  }
  const LiftResult& lift = *state.lifts.at(state.chosen_grasp);
  summary.lift.held = lift.held;
  summary.lift.height_m = lift.height;
  summary.lift.slip_mm = 1e3 * lift.slip;
  summary.lift.turn_deg = lift.turn_deg;
  summary.lift.pushes = lift.pushes;
  summary.lift.soft = lift.soft;
  summary.lift.stiff = lift.stiff;
}

// Of the state's end: of the chosen grasp's lift if there is one, else of the certified hold.
void FillNeighbours(const Timeline& timeline, const JobState& state, RunSummary& summary) {
  if (!state.certificate || timeline.job().world().num_movables() < 2) return;
  const NeighbourMotion& motion = state.chosen_grasp == 0
                                      ? state.certificate->neighbours
                                      : state.lifts.at(state.chosen_grasp)->neighbours;
  const NeighbourFacts facts = MakeNeighbourFacts(motion, timeline.job().scene());
  summary.neighbours.moved_mm = facts.moved_mm;
  summary.neighbours.turned_deg = facts.turned_deg;
  summary.neighbours.worst = facts.worst;
}

void FillMotion(const JobState& state, RunSummary& summary) {
  if (!state.motion || !state.motion_state->filled) return;
  const MotionSummary facts = state.motion->Summarize(*state.motion_state);
  summary.motion.frames = facts.frames;
  summary.motion.failed = facts.failed;
  summary.motion.loosened = facts.loosened;
  summary.motion.max_tip_error_mm = 1e3 * facts.max_tip_error;
  summary.motion.min_clearance_mm = 1e3 * facts.min_clearance;
  summary.motion.max_joint_speed = facts.rates.joint_speed;
  summary.motion.max_wrist_speed = facts.rates.wrist_speed;
  summary.motion.forearm_free = IsForearmFree(state.planner->forearm(), *state.motion_state);
  summary.motion.order = KeyframeOrderName(state.motion->config().order);
}

void FillCounts(const Timeline& timeline, const Node& node, RunSummary& summary) {
  int paths = 0, iterations = 0, rollouts = 0;
  std::set<std::string> screened;
  std::set<std::string> optimised;  // paths with a certificate, until this one's
  const Node* certified = FindOnTheWay<CertifyFacts>(node);
  for (const auto& step : timeline.nodes()) {
    paths += Details<PathFacts>(*step) != nullptr ? 1 : 0;
    if (const auto* screening = Details<ScreenFacts>(*step)) {
      iterations += screening->iterations;
      rollouts += screening->rollouts;
      screened.insert(FindOnTheWay<PathFacts>(*step)->id());
    }
    if (const auto* iteration = Details<IterationFacts>(*step)) {
      ++iterations;
      rollouts += static_cast<int>(iteration->rollouts.size());
    }
    const bool counts =
        certified == nullptr || step->number <= certified->number || summary.status != "ok";
    if (Details<CertifyFacts>(*step) != nullptr && counts) {
      optimised.insert(FindOnTheWay<PathFacts>(*step)->id());
    }
  }
  if (const Node* pruned = FindOnTheWay<PruneFacts>(node)) {
    summary.counts.kept = static_cast<int>(std::get<PruneFacts>(pruned->facts.details).kept.size());
  }
  if (const Node* mesh = FindOnTheWay<MeshFacts>(node)) {
    summary.counts.nodes = std::get<MeshFacts>(mesh->facts.details).nodes;
    summary.counts.paths = paths;
    summary.counts.iterations = iterations;
    summary.counts.rollouts = rollouts;
  }
  if (!optimised.empty()) {
    summary.n_paths = static_cast<int>(optimised.size());
    summary.n_screened = static_cast<int>(screened.size());
  }
}

void FillObjectMotion(const Timeline& timeline, const JobState& state, RunSummary& summary) {
  const std::vector<WorldState> rollout = GetRollout(state);
  const Motion motion = CalcObjectMotion(timeline.job().world(), rollout.front(), rollout.back());
  summary.object_motion.translation_m = motion.moved;
  summary.object_motion.rotation_deg = RadToDeg(motion.rotated);
  for (const WorldState& moment : rollout) {
    summary.object_motion.max_speed =
        std::max(summary.object_motion.max_speed, moment.bodies[0].v_WB.norm());
  }
}

// Whether a path, a mean or a plan on the way to a node was picked by hand (honesty rule 3).
bool IsByHand(const Node& node) {
  for (const Node* at = &node; at != nullptr; at = at->parent) {
    if (at->command.verb == Verb::kPath && at->command.options.contains("nodes")) return true;
    if (at->command.verb == Verb::kIterate && at->command.options.contains("nominal")) return true;
    if (at->command.verb == Verb::kCertify && at->command.options.contains("stages")) return true;
  }
  return false;
}

}  // namespace

std::vector<WorldState> GetRollout(const JobState& state) {
  std::vector<WorldState> rollout;
  if (state.certificate) {
    for (const TraceRow& row : state.certificate->trace) rollout.push_back(row.state);
  } else if (state.simulation) {
    for (int i = 0; i < state.simulation->num_states(); ++i) {
      rollout.push_back(state.simulation->state_at(i));
    }
  } else {
    rollout.push_back(state.start);
  }
  return rollout;
}

std::optional<std::string> StatusAt(const Timeline& timeline, const Node& node) {
  const VerdictFacts* verdict = FindVerdict(timeline);
  if (verdict != nullptr && verdict->feasible > 0) return "start_graspable";
  // Asked for where it counts alone: a recorded step has to be done again for it.
  const auto state = [&] { return timeline.GetState(node); };
  switch (node.progress.reached) {
    case Progress::Reached::kNothing:
      return std::nullopt;
    case Progress::Reached::kTrajectory:
      return "not_certified";
    case Progress::Reached::kCertified:
      if (AllGraspsTried(*state())) return "no_feasible_grasp";
      return std::nullopt;
    case Progress::Reached::kFeasible:
      if (AllGraspsTried(*state()) && AllFeasibleLifted(*state())) return "lift_failed";
      return std::nullopt;
    case Progress::Reached::kLifted:
      if (IsMotionDecided(*state())) return "motion_failed";
      return std::nullopt;
    case Progress::Reached::kMoved:
      return "neighbours_disturbed";
    case Progress::Reached::kOk:
      return "ok";
  }
  return std::nullopt;
}

const Node& FindFurthest(const Timeline& timeline) {
  const Node* best = &timeline.root();
  for (const auto& node : timeline.nodes()) {
    if (Details<VerdictFacts>(*node) != nullptr) continue;
    if (!(node->progress < best->progress)) best = node.get();
  }
  return *best;
}

RunSummary Summarize(const Timeline& timeline, const Node& node) {
  const Job& job = timeline.job();
  const auto state = timeline.GetState(node);
  RunSummary summary;
  summary.scene = job.scene().name;
  summary.seed = job.setup().seed;
  summary.status = StatusAt(timeline, node);
  summary.within_rules = RuleDepartures(job.scene(), state->config).empty() && !IsByHand(node);
  summary.physics.mu_tip = job.scene().fingertips.friction;
  summary.physics.max_force_N = job.scene().fingertips.max_force;
  summary.physics.dt = job.world().config().dt;
  if (const VerdictFacts* verdict = FindVerdict(timeline)) {
    summary.start_grasps.tried = verdict->tried;
    summary.start_grasps.feasible = verdict->feasible;
    summary.start_grasps.certified = verdict->verdict == "certified";
    summary.start_grasps.mu_star = verdict->mu_star;
  }
  FillTrajectory(*state, node, summary);
  FillGrasps(*state, summary);
  FillChosen(timeline, *state, summary);
  FillNeighbours(timeline, *state, summary);
  FillMotion(*state, summary);
  FillCounts(timeline, node, summary);
  FillObjectMotion(timeline, *state, summary);
  return summary;
}

}  // namespace pregrasp
