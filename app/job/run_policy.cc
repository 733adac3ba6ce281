#include "app/job/run_policy.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "app/core/interrupt.h"

namespace pregrasp {
namespace {

using Node = Timeline::Node;

bool IsComplete(const Node& node) {
  const auto* pruning = std::get_if<PruneFacts>(&node.facts.details);
  return pruning != nullptr && pruning->complete;
}

// The most frequent verdict on the grasps of a state.
std::string CommonReason(const JobState& state) {
  std::map<std::string, int> counts;
  for (const CompletedGrasp& grasp : state.grasps->grasps) {
    ++counts[GraspStatusName(grasp.result.status)];
  }
  const auto most =
      std::max_element(counts.begin(), counts.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  return fmt::format("{} ({} of {})", most->first, most->second, state.grasps->grasps.size());
}

// The step of the path of `rank`; null if there are not so many.
const Node* TakePath(Timeline& timeline, const Node& graph, int rank) {
  const auto state = timeline.GetState(graph);
  if (state->paths->Find(state->config.order, state->config.stages, rank) == nullptr) {
    return nullptr;
  }
  return &timeline.Do(graph, Verb::kPath, {{"rank", rank}});
}

// What is to be done next to a motion that has begun; nothing when it is finished.
std::optional<Verb> NextOfMotion(const Timeline& timeline, const Node& node) {
  const auto state = timeline.GetState(node);
  const MotionState& motion = *state->motion_state;
  if (motion.solved_keys.size() < motion.keys.size()) return Verb::kKeyframe;
  if (!motion.filled) return Verb::kFill;
  if (!motion.finished) return Verb::kSmooth;
  return std::nullopt;
}

// Keyframes, in-betweens and smoothing of a motion that has begun; with `give_up`, until there is
// no hope of a motion without failure.
const Node& DoMotion(Timeline& timeline, const Node& node, bool give_up) {
  const Node* at = &node;
  while (const std::optional<Verb> verb = NextOfMotion(timeline, *at)) {
    ThrowIfInterrupted();
    if (give_up && timeline.GetState(*at)->motion_state->is_hopeless()) break;
    at = &timeline.Do(*at, *verb);
  }
  return *at;
}

// Why a motion is none.
std::string ExplainFailure(const HandMotion& motion, const MotionState& state) {
  for (const int key : state.solved_keys) {
    if (!state.keys[key].failed()) continue;
    const MotionFrameTask& frame = state.task->frames[state.task->keyframes[key]];
    return fmt::format("the hand has no pose at keyframe {} of {} ({})", key + 1, state.keys.size(),
                       MotionPhaseName(frame.phase));
  }
  if (state.is_hopeless()) return "no way was found for the hand between two keyframes";
  return fmt::format("the hand motion fails in {} frames", motion.Summarize(state).failed);
}

class Runner {
 public:
  Runner(Timeline& timeline, const RunConfig& config,
         const std::function<void(const RunProgress&)>& progress)
      : timeline_(timeline), config_(config), progress_(progress) {}

  RunResult Run() {
    Report("start verdict", 0, 1);
    const Node& verdict = timeline_.Do(timeline_.root(), Verb::kVerdict);
    if (std::get<VerdictFacts>(verdict.facts.details).feasible > 0) {
      return {&timeline_.root(), "start_graspable", {}};
    }
    const Node& graph = BuildGraph();
    const bool paper = timeline_.GetState(graph)->config.order == PathOrder::kPaper;
    std::vector<const Node*> screened;
    if (!paper) screened = ScreenPaths(timeline_, graph, progress_);
    RunResult result;
    for (int number = 1; number <= config_.paths; ++number) {
      const Node* path = FindPath(graph, screened, number);
      if (path == nullptr) break;
      const Node& end = Try(*path, number);
      result.reasons.push_back(Explain(end));
      const bool success = end.progress.reached == Progress::Reached::kOk;
      if (success && result.end == nullptr) result.end = &end;
      if (success && !config_.all) break;
    }
    if (result.end == nullptr) result.end = &FindFurthest(timeline_);
    result.status = StatusAt(timeline_, *result.end).value_or("not_certified");
    return result;
  }

 private:
  void Report(const std::string& stage, int done, int total) const {
    if (progress_) progress_({stage, done, total});
    ThrowIfInterrupted();
  }

  const Node& BuildGraph() {
    Report("contact graph", 0, 1);
    nlohmann::json options = nlohmann::json::object();
    if (!config_.settings.empty()) options["settings"] = config_.settings;
    const Node& mesh = timeline_.Do(timeline_.root(), Verb::kMesh, std::move(options));
    return PruneAll(timeline_, timeline_.Do(mesh, Verb::kScore), {});
  }

  // The `number`-th path to optimise: those that were screened by what that found, then the others
  // by rank; null beyond the last one.
  const Node* FindPath(const Node& graph, const std::vector<const Node*>& screened, int number) {
    if (number <= std::ssize(screened)) return screened[number - 1];
    return TakePath(timeline_, graph, number);
  }

  // A plan of a path: its certificate, and the last step of its grasps and lifts, if it has any.
  struct TriedPlan {
    int plan = 1;  // its number
    const Node* certified = nullptr;
    const Node* end = nullptr;
    std::vector<int> lifting = {};  // the most promising grasp first, by number

    int worlds_held() const {
      const auto& robust = std::get<CertifyFacts>(certified->facts.details).robust;
      return robust ? robust->held : 0;
    }
  };

  // Of the plans that go furthest, those with at least half as many grasps that lift as any; among
  // them, the more worlds a plan holds in the better.
  static void Order(std::vector<TriedPlan>& plans) {
    int most = 0;
    for (const TriedPlan& plan : plans) most = std::max(most, plan.end->progress.lifted);
    const auto key = [&](const TriedPlan& plan) {
      const Progress& progress = plan.end->progress;
      return std::tuple(progress.reached, 2 * progress.lifted >= most, plan.worlds_held(),
                        progress.lifted, progress.feasible);
    };
    std::stable_sort(plans.begin(), plans.end(),
                     [&](const TriedPlan& x, const TriedPlan& y) { return key(x) > key(y); });
  }

  // Further; or as far, with fewer frames beyond the hand's limits.
  static bool GoesFurther(const Node& x, const Node& y) {
    const auto over_limits = [](const Node& node) {
      const auto* motion = std::get_if<MotionFacts>(&node.facts.details);
      return motion == nullptr ? 0 : motion->over_limits;
    };
    const Progress &a = x.progress, &b = y.progress;
    return std::tuple(a.reached, -over_limits(x), a.lifted, a.feasible) >
           std::tuple(b.reached, -over_limits(y), b.lifted, b.feasible);
  }

  // What hand motions to the grasps of some plans came to.
  struct TriedMotions {
    const Node* best = nullptr;
    bool done = false;  // without failure and within the hand's limits
    // The factor by which the slowest motion is too fast for the hand; unset where none was filled.
    std::optional<double> haste = {};
  };

  const Node& Try(const Node& path, int number) {
    const std::string name = fmt::format("path {} of {}", number, config_.paths);
    const Node& optimised = Optimise(path, name);
    const auto count = std::ssize(timeline_.GetState(optimised)->optimization->plans);
    std::vector<TriedPlan> plans;
    int certified = 0, lifting = 0;
    for (int plan = 1; plan <= count && (certified < config_.plans || lifting == 0); ++plan) {
      plans.push_back(TryPlan(optimised, plan, {}, name));
      certified += plans.back().end->progress.reached >= Progress::Reached::kCertified ? 1 : 0;
      lifting += plans.back().lifting.empty() ? 0 : 1;
    }
    Order(plans);
    TriedMotions motions = MoveHands(plans, name);
    if (!motions.done && motions.haste.value_or(1.0) > 1.0) {
      const Node* const best = motions.best;
      plans = SlowDown(optimised, plans, *motions.haste, name);
      motions = MoveHands(plans, name);
      if (!motions.done && !GoesFurther(*motions.best, *best)) motions.best = best;
    }
    const bool ok = motions.best->progress.reached == Progress::Reached::kOk;
    return ok ? ShowFrames(timeline_, *motions.best) : *motions.best;
  }

  // The best plans with a grasp that lifts, as much slower as the hand needs: certified, completed
  // and lifted once more.
  std::vector<TriedPlan> SlowDown(const Node& optimised, const std::vector<TriedPlan>& plans,
                                  double haste, const std::string& name) {
    constexpr std::size_t kSlowed = 2;
    constexpr double kMostHaste = 4.0, kRoom = 1.1;
    const nlohmann::json settings = {
        {"certify.slow", std::ceil(10.0 * kRoom * std::min(haste, kMostHaste)) / 10.0}};
    std::vector<TriedPlan> slowed;
    for (const TriedPlan& plan : plans) {
      if (plan.lifting.empty() || slowed.size() == kSlowed) continue;
      slowed.push_back(TryPlan(optimised, plan.plan, {{"settings", settings}}, name));
    }
    Order(slowed);
    return slowed;
  }

  // What keeps the hand from one grasp often keeps it from the next: plans take turns.
  TriedMotions MoveHands(const std::vector<TriedPlan>& plans, const std::string& name) {
    TriedMotions tried;
    tried.best = plans.front().end;
    int motions = 0;
    for (std::size_t turn = 0; turn < static_cast<std::size_t>(config_.motions); ++turn) {
      for (const TriedPlan& plan : plans) {
        if (turn >= plan.lifting.size() || motions == config_.motions) continue;
        Report(name + ", hand motion", motions++, config_.motions);
        const Node& moved = MoveHand(*plan.end, plan.lifting[turn]);
        if (tried.best == plan.end || GoesFurther(moved, *tried.best)) tried.best = &moved;
        const auto* facts = std::get_if<MotionFacts>(&moved.facts.details);
        if (facts == nullptr) continue;
        const double haste =
            std::max(facts->rates.speed_share, std::sqrt(facts->rates.acceleration_share));
        tried.haste = std::min(haste, tried.haste.value_or(haste));
        if (moved.progress.reached == Progress::Reached::kOk && facts->over_limits == 0) {
          tried.best = &moved;
          tried.done = true;
          return tried;
        }
      }
    }
    return tried;
  }

  TriedPlan TryPlan(const Node& optimised, int plan, nlohmann::json options,
                    const std::string& name) {
    if (options.is_null()) options = nlohmann::json::object();
    if (plan > 1) options["plan"] = plan;
    Report(name + ", plans and their grasps", plan - 1, kMostPlans);
    const Node& certified = timeline_.Do(optimised, Verb::kCertify, options);
    if (!std::get<CertifyFacts>(certified.facts.details).certified ||
        timeline_.GetState(certified)->release->conditions.empty()) {
      return {plan, &certified, &certified};
    }
    const Node& end = CompleteGrasps(timeline_, certified, nlohmann::json::object());
    TriedPlan tried{plan, &certified, &end};
    const auto state = timeline_.GetState(end);
    for (const int number : OrderGrasps(*state)) {
      if (state->lifts.at(number)->held) tried.lifting.push_back(number);
    }
    return tried;
  }

  const Node& Optimise(const Node& path, const std::string& name) {
    const Node* node = &path;
    bool ended = false;
    while (!ended) {
      const auto* last = std::get_if<IterationFacts>(&node->facts.details);
      Report(name + ", trajectory", last == nullptr ? 0 : last->iteration,
             last == nullptr ? 1 : last->limit);
      node = &timeline_.Do(*node, Verb::kIterate);
      ended = !std::get<IterationFacts>(node->facts.details).end.empty();
    }
    return *node;
  }

  const Node& MoveHand(const Node& grasps, int number) {
    return DoMotion(timeline_, timeline_.Do(grasps, Verb::kKeyframe, {{"grasp", number}}), true);
  }

  std::string Explain(const Node& end) const {
    const auto state = timeline_.GetState(end);
    const std::string head =
        fmt::format("path {}, cost {:.3f}: ", state->path->rank, state->optimization->best_cost);
    if (!state->certificate->certified) {
      std::string reasons;
      for (const CertifyReason reason : state->certificate->reasons) {
        reasons += (reasons.empty() ? "" : "; ") + std::string(CertifyReasonText(reason));
      }
      return head + "not certified: " + reasons;
    }
    if (!state->grasps)
      return head + "certified, but no place that was tried is free for a fingertip";
    if (end.progress.feasible == 0) {
      return head + "certified, but no grasp is feasible, most often because of " +
             CommonReason(*state);
    }
    const std::string share = fmt::format("{} of {} grasps are feasible", end.progress.feasible,
                                          state->grasps->grasps.size());
    if (end.progress.lifted == 0) {
      const int first = OrderGrasps(*state).front();
      return head + share + fmt::format(", none lifts; number {}: ", first) +
             pregrasp::Explain(*state->lifts.at(first), timeline_.job().scene());
    }
    const std::string lifted = share + fmt::format(", {} of them lift", end.progress.lifted);
    if (end.progress.reached == Progress::Reached::kMoved) {
      const LiftResult& lift = *state->lifts.at(state->chosen_grasp);
      const NeighbourMotion& neighbours =
          lift.neighbours.disturbed ? lift.neighbours : state->certificate->neighbours;
      return head + lifted +
             fmt::format(", and the hand gets there, but {} is turned or knocked down",
                         timeline_.job().scene().bodies[neighbours.worst->value].name);
    }
    if (end.progress.reached != Progress::Reached::kOk) {
      return head + lifted + ", but " + ExplainFailure(*state->motion, *state->motion_state);
    }
    return head + lifted + ", and the hand gets there";
  }

  Timeline& timeline_;
  const RunConfig& config_;
  const std::function<void(const RunProgress&)>& progress_;
};

}  // namespace

void RunConfig::Validate() const {
  RequireWithin("", "paths", kPaths, paths);
  RequireWithin("", "motions", {1, 1000, 1}, motions);
  RequireWithin("", "plans", {1, kMostPlans, 1}, plans);
}

RunResult RunPlanner(Timeline& timeline, const RunConfig& config,
                     const std::function<void(const RunProgress&)>& progress) {
  config.Validate();
  return Runner(timeline, config, progress).Run();
}

std::vector<const Node*> ScreenPaths(Timeline& timeline, const Node& graph,
                                     const std::function<void(const RunProgress&)>& progress) {
  const ScreenConfig config = timeline.GetState(graph)->config.screen;
  const auto facts = [](const Node* node) -> const ScreenFacts& {
    return std::get<ScreenFacts>(node->facts.details);
  };
  std::vector<const Node*> paths;
  std::ptrdiff_t going_on = config.paths > 1 ? config.paths : 0;
  int clear = 0;
  for (int round = 1; round <= config.rounds && going_on > 0 && clear < config.enough; ++round) {
    clear = 0;
    for (std::ptrdiff_t i = 0; i < going_on && clear < config.enough; ++i) {
      if (progress) {
        progress({fmt::format("screening, round {} of {}", round, config.rounds),
                  static_cast<int>(i), static_cast<int>(going_on)});
      }
      ThrowIfInterrupted();
      if (round == 1) {
        const Node* path = TakePath(timeline, graph, static_cast<int>(i) + 1);
        if (path == nullptr) break;
        paths.push_back(path);
      }
      paths[i] = &timeline.Do(*paths[i], Verb::kScreen);
      clear += facts(paths[i]).value - facts(paths[i]).rest_reward >= config.clear ? 1 : 0;
    }
    // In a later round those that were not tried any more keep what the round before found.
    going_on = std::min(going_on, std::ssize(paths));
    std::stable_sort(paths.begin(), paths.begin() + going_on,
                     [&](const Node* x, const Node* y) { return facts(x).value > facts(y).value; });
    going_on = (going_on + 1) / 2;
  }
  return paths;
}

const Node& PruneAll(Timeline& timeline, const Node& scored, nlohmann::json options) {
  const Node* node = &scored;
  while (!IsComplete(*node)) {
    node = &timeline.Do(*node, Verb::kPrune, std::move(options));
    options = nlohmann::json::object();
  }
  return *node;
}

const Node& CompleteGrasps(Timeline& timeline, const Node& certified, nlohmann::json options) {
  const Node* node = &timeline.Do(certified, Verb::kGrasp, std::move(options));
  auto state = timeline.GetState(*node);
  const int count = static_cast<int>(state->grasps->grasps.size());
  while (timeline.GetState(*node)->num_grasps < count) {
    ThrowIfInterrupted();
    node = &timeline.Do(*node, Verb::kGrasp);
  }
  for (int number = 1; number <= count; ++number) {
    ThrowIfInterrupted();
    if (!state->grasps->grasps[number - 1].feasible()) continue;
    node = &timeline.Do(*node, Verb::kLift, {{"grasp", number}});
  }
  return *node;
}

std::vector<int> OrderGrasps(const JobState& state) {
  std::vector<int> order;
  for (const auto& [number, lift] : state.lifts) order.push_back(number);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    const LiftResult &lift_a = *state.lifts.at(a), &lift_b = *state.lifts.at(b);
    if (WithstandsMore(lift_a, lift_b) || WithstandsMore(lift_b, lift_a)) {
      return WithstandsMore(lift_a, lift_b);
    }
    const CompletedGrasp &grasp_a = state.grasps->grasps[a - 1],
                         &grasp_b = state.grasps->grasps[b - 1];
    if (grasp_a.source != grasp_b.source) return grasp_a.source == GraspSource::kGenerator;
    if (lift_a.forearm_free != lift_b.forearm_free) return lift_a.forearm_free;
    return grasp_a.result.wrench->margin > grasp_b.result.wrench->margin;
  });
  return order;
}

const Node& FinishMotion(Timeline& timeline, const Node& node) {
  return DoMotion(timeline, node, false);
}

const Node& ShowFrames(Timeline& timeline, const Node& finished) {
  const Node* last = &finished;
  const int count = static_cast<int>(timeline.GetState(finished)->motion_state->frames.size());
  for (int frame = 1; frame <= count; ++frame) {
    ThrowIfInterrupted();
    last = &timeline.Do(finished, Verb::kFrame, {{"frame", frame}});
  }
  return *last;
}

}  // namespace pregrasp
