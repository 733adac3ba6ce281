#include <fmt/format.h>

#include <algorithm>

#include "bindings/lua_grasp.h"
#include "bindings/lua_planner.h"

namespace pregrasp {
namespace {

// The cost's terms are those of app/trajectory/cost.h.
Schema MakeCostSchema() {
  Schema schema{"CostTerms", {"total", "stage_scores", "final_score", "room", "reward"}};
  for (const CostTerm& term : CostTerms()) schema.keys.emplace_back(term.name);
  return schema;
}
const Schema kCostTerms = MakeCostSchema();
const Schema kScreening{
    "Screening",
    {"round", "iterations", "rollouts", "value", "rest_reward", "score_scale", "best", "step_id"}};
const Schema kNeighbours{"NeighbourMotion", {"worst", "moved_mm", "turned_deg", "disturbed"}};
const Schema kRobustness{"Robustness",
                         {"worlds", "held", "worst_shift_mm", "worst_turn_deg", "elsewhere"}};
const Schema kPlanStage{"PlanStage", {"thumb", "index"}};
const Schema kPlanFinger{"PlanFinger", {"on", "kept", "p_OC", "nhat_O", "p_WTargets"}};

// Which plan is certified: one of those kept, by its number, or stages made by hand.
struct PlanChoice {
  nlohmann::json options = nlohmann::json::object();  // of the command
};

}  // namespace

template <>
struct LuaValue<PlanChoice> {
  static PlanChoice Read(lua_State* L, int index, const std::string& path);
};

namespace {

nlohmann::json PointsJson(const std::vector<Vector3>& points) {
  nlohmann::json list = nlohmann::json::array();
  for (const Vector3& p : points) list.push_back({p.x(), p.y(), p.z()});
  return list;
}

// A finger of a stage as Trajectory.stages has it, without what follows from the rest; null where
// it is off.
nlohmann::json ReadPlanFinger(lua_State* L, int index, const std::string& path) {
  const Fields fields(L, index, kPlanFinger, path + ".");
  nlohmann::json finger = nlohmann::json::object();
  if (!fields.Optional("on", true)) return nullptr;
  if (fields.Has("p_OC") && !fields.Optional("kept", false)) {
    const auto p_OC = fields.Required<Vector3>("p_OC");
    finger["p_OC"] = {p_OC.x(), p_OC.y(), p_OC.z()};
  }
  finger["p_WTargets"] = PointsJson(fields.Required<std::vector<Vector3>>("p_WTargets"));
  return finger;
}

nlohmann::json ReadPlanStage(lua_State* L, int index, const std::string& path) {
  const Fields fields(L, index, kPlanStage, path + ".");
  nlohmann::json stage = nlohmann::json::object();
  for (const std::string& name : kPlanStage.keys) {
    if (!fields.Has(name)) continue;
    fields.Push(name);
    if (!lua_istable(L, -1)) fields.Refuse(name, "a table");
    nlohmann::json finger = ReadPlanFinger(L, -1, path + "." + name);
    lua_pop(L, 1);
    if (!finger.is_null()) stage[name] = std::move(finger);
  }
  return stage;
}

// The optimiser.

// A plan has as many knots as before. @throws InputError for settings that ask for others.
void RequireSameKnots(const LuaOptimizer& optimizer, const nlohmann::json& settings) {
  const auto knots = settings.find("mppi.knots");
  const int now = optimizer.state()->config.mppi.timing.knots;
  if (knots != settings.end() && optimizer.facts() != nullptr && *knots != now) {
    throw InputError("", "knots", std::to_string(now) + ", as before", knots->dump());
  }
}

bool OptimizerConverged(LuaOptimizer& optimizer) {
  return optimizer.facts() != nullptr && optimizer.facts()->converged;
}

// One iteration, unless it has ended. @param stopped  gets whether break_when says yes to it.
bool Iterate(lua_State* L, LuaOptimizer& optimizer, bool* stopped) {
  const IterationFacts* last = optimizer.facts();
  const bool as_before = optimizer.settings.empty() && optimizer.nominal == 0;
  if (last != nullptr && !last->end.empty() && as_before) return false;
  nlohmann::json options = nlohmann::json::object();
  if (optimizer.nominal > 0) options["nominal"] = optimizer.nominal;
  optimizer.Do(Verb::kIterate, std::move(options));
  optimizer.nominal = 0;
  CountSteps(L, *optimizer.session);
  *stopped = StopsAt(L, optimizer.session, *optimizer.node);
  return true;
}

bool OptimizerStep(lua_State* L, LuaOptimizer& optimizer) {
  bool stopped = false;
  return Iterate(L, optimizer, &stopped);
}

// Iterations until it ends, break_when says yes, or `count` are done.
bool OptimizerRun(lua_State* L, LuaOptimizer& optimizer, const std::optional<int>& count) {
  if (count && *count < 1) {
    throw InputError("", "count", "a whole number from 1", std::to_string(*count));
  }
  bool stopped = false;
  int done = 0;
  while (!stopped && (!count || done < *count) && Iterate(L, optimizer, &stopped)) ++done;
  return stopped;
}

// Settings of the next iteration and those after it.
void OptimizerSet(LuaOptimizer& optimizer, const OptimizeOptions& options) {
  nlohmann::json settings = optimizer.settings;
  settings.update(options.ToSettings());
  RequireSameKnots(optimizer, settings);
  optimizer.settings = std::move(settings);
}

// The plan of a rollout takes the mean's place in the next iteration.
void OptimizerSetNominal(LuaOptimizer& optimizer, int number) {
  const auto count = optimizer.facts() == nullptr ? 0 : std::ssize(optimizer.facts()->rollouts);
  if (number < 0 || number > count) {
    throw InputError(
        "", "number",
        fmt::format("a rollout of the last iteration, 1 to {}, or 0 for the mean", count),
        std::to_string(number));
  }
  optimizer.nominal = number;
}

void OptimizerForward(LuaOptimizer& optimizer, const std::optional<int>& steps) {
  optimizer.Forward(steps.value_or(1));
  optimizer.nominal = 0;
}

Pushed OptimizerScreen(lua_State* L, LuaOptimizer& optimizer, const ScreenOptions& options) {
  optimizer.settings.update(options.ToSettings());
  optimizer.Do(Verb::kScreen);
  CountSteps(L, *optimizer.session);
  const auto& facts = std::get<ScreenFacts>(optimizer.node->facts.details);
  RecordWriter record(L, kScreening);
  record.Set("round", facts.round)
      .Set("iterations", facts.iterations)
      .Set("rollouts", facts.rollouts)
      .Set("value", facts.value)
      .Set("rest_reward", facts.rest_reward)
      .Set("score_scale", facts.score_scale)
      .Set("step_id", optimizer.step_id());
  PushCost(L, facts.best);
  record.SetTop("best");
  return {1};
}

void OptimizerBack(LuaOptimizer& optimizer, const std::optional<int>& steps) {
  optimizer.Back(steps.value_or(1), optimizer.first);
  optimizer.nominal = 0;
}

Pushed OptimizerFork(lua_State* L, LuaOptimizer& optimizer, const OptimizeOptions& options) {
  auto fork = std::make_shared<LuaOptimizer>(optimizer);
  fork->settings.update(options.ToSettings());
  RequireSameKnots(*fork, fork->settings);
  PushObject(L, std::move(fork));
  return {1};
}

Pushed OptimizerCertify(lua_State* L, LuaOptimizer& optimizer, const CertifyOptions& options,
                        const std::optional<PlanChoice>& plan) {
  auto trajectory = std::make_shared<LuaTrajectory>(
      LuaTrajectory{{optimizer.session, optimizer.node, options.ToSettings()}});
  trajectory->Do(Verb::kCertify, plan ? plan->options : nlohmann::json::object());
  CountSteps(L, *trajectory->session);
  StopsAt(L, trajectory->session, *trajectory->node);
  PushObject(L, std::move(trajectory));
  return {1};
}

void OptimizerShot(lua_State* L, LuaOptimizer& optimizer, const ShotOptions& options) {
  TakeShot(L, *optimizer.session, *optimizer.node, options);
}

int OptimizerIteration(LuaOptimizer& optimizer) {
  return optimizer.facts() == nullptr ? 0 : optimizer.facts()->iteration;
}
// nil before the first iteration
std::optional<double> OptimizerBestCost(LuaOptimizer& optimizer) {
  if (optimizer.facts() == nullptr) return std::nullopt;
  return optimizer.facts()->best_cost;
}
std::optional<double> OptimizerMeanCost(LuaOptimizer& optimizer) {
  if (optimizer.facts() == nullptr) return std::nullopt;
  return optimizer.facts()->mean_cost;
}
// nil before the first iteration
std::optional<double> OptimizerScoreScale(LuaOptimizer& optimizer) {
  if (optimizer.facts() == nullptr) return std::nullopt;
  return optimizer.facts()->score_scale;
}
Pushed OptimizerBest(lua_State* L, LuaOptimizer& optimizer) {
  optimizer.facts() == nullptr ? lua_pushnil(L) : PushCost(L, optimizer.facts()->best);
  return {1};
}
// The costs of the iterations up to here.
std::vector<double> History(const LuaOptimizer& optimizer, double IterationFacts::*cost) {
  std::vector<double> history;
  for (const Timeline::Node* at = optimizer.node; at != optimizer.first; at = at->parent) {
    const auto* facts = std::get_if<IterationFacts>(&at->facts.details);
    if (facts != nullptr) history.push_back(facts->*cost);  // and not a round of screening
  }
  std::reverse(history.begin(), history.end());
  return history;
}
std::vector<double> OptimizerBestHistory(LuaOptimizer& optimizer) {
  return History(optimizer, &IterationFacts::best_cost);
}
std::vector<double> OptimizerMeanHistory(LuaOptimizer& optimizer) {
  return History(optimizer, &IterationFacts::mean_cost);
}
int OptimizerRank(LuaOptimizer& optimizer) { return optimizer.path_rank(); }
std::string OptimizerStepId(LuaOptimizer& optimizer) { return optimizer.step_id(); }

int OptimizerToString(lua_State* L) {
  const auto optimizer = FindObject<LuaOptimizer>(L, 1);
  const std::string text = optimizer
                               ? fmt::format("Optimizer(path {}, iteration {})",
                                             optimizer->path_rank(), OptimizerIteration(*optimizer))
                               : "Optimizer";
  lua_pushlstring(L, text.data(), text.size());
  return 1;
}

// The certified trajectory.

Pushed TrajectoryWhy(lua_State* L, LuaTrajectory& trajectory) {
  return PushExplanation(L, ExplainCertificate(trajectory.session->scene(), trajectory.facts(),
                                               trajectory.state()->config.certify));
}

Pushed TrajectoryWhyNot(lua_State* L, LuaTrajectory& trajectory, LuaTrajectory& other) {
  return PushExplanation(
      L, ExplainCertificateAgainst(trajectory.session->scene(), trajectory.step_id(),
                                   trajectory.facts(), other.step_id(), other.facts(),
                                   trajectory.state()->config.certify));
}

void TrajectoryShot(lua_State* L, LuaTrajectory& trajectory, const ShotOptions& options) {
  TakeShot(L, *trajectory.session, *trajectory.node, options);
}

Pushed TrajectoryBody(lua_State* L, LuaTrajectory& trajectory, const std::string& name) {
  PushBody(L, trajectory.session->world(), trajectory.state()->certificate->full.end,
           FindBody(trajectory.session->scene(), name));
  return {1};
}

bool TrajectoryCertified(LuaTrajectory& t) { return t.facts().certified; }
std::vector<std::string> TrajectoryReasons(LuaTrajectory& t) { return t.facts().reasons; }
double TrajectorySlow(LuaTrajectory& t) { return t.facts().slow; }
double TrajectoryHoldShift(LuaTrajectory& t) { return t.facts().hold_shift_mm; }
double TrajectoryHoldTurn(LuaTrajectory& t) { return t.facts().hold_turn_deg; }
double TrajectoryStepShift(LuaTrajectory& t) { return t.facts().step_shift_mm; }
double TrajectoryStepTurn(LuaTrajectory& t) { return t.facts().step_turn_deg; }
double TrajectoryPenetration(LuaTrajectory& t) { return t.facts().max_penetration_mm; }
int TrajectoryNotConverged(LuaTrajectory& t) { return t.facts().not_converged; }
double TrajectoryUnresolved(LuaTrajectory& t) { return t.facts().unresolved_mm; }
double TrajectoryTipOverlap(LuaTrajectory& t) { return t.facts().max_tip_overlap_mm; }
double TrajectoryMaxSpeed(LuaTrajectory& t) { return t.facts().max_speed; }
double TrajectoryMaxForce(LuaTrajectory& t) { return t.facts().max_force_N; }
double TrajectorySeconds(LuaTrajectory& t) { return t.facts().seconds; }
std::vector<double> TrajectoryWaits(LuaTrajectory& t) { return t.facts().waits; }
std::optional<double> TrajectoryOutOfReach(LuaTrajectory& t) { return t.facts().out_of_reach_t; }
int TrajectorySteps(LuaTrajectory& t) {
  return static_cast<int>(t.state()->certificate->trace.size()) - 1;
}
bool TrajectoryStays(LuaTrajectory& t) { return t.facts().stays_when_released; }
double TrajectoryReleasedShift(LuaTrajectory& t) { return t.facts().released_shift_mm; }
double TrajectoryReleasedTurn(LuaTrajectory& t) { return t.facts().released_turn_deg; }
std::string TrajectoryStepId(LuaTrajectory& t) { return t.step_id(); }

Pushed TrajectoryPressing(lua_State* L, LuaTrajectory& trajectory) {
  PushGraspContacts(L, trajectory.state()->release->pressing);
  return {1};
}

Pushed TrajectoryObject(lua_State* L, LuaTrajectory& trajectory) {
  PushBody(L, trajectory.session->world(), trajectory.state()->certificate->full.end, 0);
  return {1};
}

Pushed TrajectoryNeighbours(lua_State* L, LuaTrajectory& trajectory) {
  PushNeighbours(L, trajectory.facts().neighbours);
  return {1};
}

// nil where it is not certified
Pushed TrajectoryRobust(lua_State* L, LuaTrajectory& trajectory) {
  const std::optional<RobustFacts>& robust = trajectory.facts().robust;
  if (!robust) {
    lua_pushnil(L);
    return {1};
  }
  RecordWriter record(L, kRobustness);
  record.Set("worlds", robust->worlds)
      .Set("held", robust->held)
      .Set("worst_shift_mm", robust->worst_shift_mm)
      .Set("worst_turn_deg", robust->worst_turn_deg)
      .Set("elsewhere", robust->elsewhere);
  return {1};
}

Pushed TrajectoryStages(lua_State* L, LuaTrajectory& trajectory) {
  const std::vector<StageFacts>& stages = trajectory.facts().stages;
  lua_createtable(L, static_cast<int>(stages.size()), 0);
  for (std::size_t i = 0; i < stages.size(); ++i) {
    RecordWriter stage(L, kPlanStage);
    for (const StageFingerFacts& finger : stages[i]) {
      RecordWriter(L, kPlanFinger)
          .Set("on", finger.on)
          .Set("kept", finger.kept)
          .Set("p_OC", finger.p_OC)
          .Set("nhat_O", finger.nhat_O)
          .Set("p_WTargets", finger.p_WTargets);
      stage.SetTop(FingerName(finger.finger));
    }
    lua_rawseti(L, -2, static_cast<lua_Integer>(i) + 1);
  }
  return {1};
}

int TrajectoryToString(lua_State* L) {
  const auto trajectory = FindObject<LuaTrajectory>(L, 1);
  const std::string text =
      trajectory ? fmt::format("Trajectory(path {}, {})", trajectory->facts().path,
                               trajectory->facts().certified ? "certified" : "not certified")
                 : "Trajectory";
  lua_pushlstring(L, text.data(), text.size());
  return 1;
}

}  // namespace

void PushCost(lua_State* L, const CostFacts& cost) {
  RecordWriter record(L, kCostTerms);
  record.Set("total", cost.total)
      .Set("stage_scores", cost.stage_scores)
      .Set("final_score", cost.final_score)
      .Set("room", cost.room)
      .Set("reward", cost.reward);
  for (const CostTermFacts& term : cost.terms) record.Set(term.name.c_str(), term.value);
}

void PushNeighbours(lua_State* L, const NeighbourFacts& facts) {
  RecordWriter record(L, kNeighbours);
  record.Set("moved_mm", facts.moved_mm)
      .Set("turned_deg", facts.turned_deg)
      .Set("disturbed", facts.disturbed);
  if (!facts.worst.empty()) record.Set("worst", facts.worst);
}

Pushed PathOptimize(lua_State* L, LuaPath& path, const OptimizeOptions& options) {
  path.Record();
  const Timeline::Node* step = path.cursor.node;
  PushObject(L, std::make_shared<LuaOptimizer>(
                    LuaOptimizer{{path.cursor.session, step, options.ToSettings()}, step}));
  return {1};
}

const ClassInfo& OptimizerClass() {
  static const ClassInfo info{"Optimizer",
                              {
                                  Method<&OptimizerStep>("step"),
                                  Method<&OptimizerRun>("run", "count"),
                                  Method<&OptimizerScreen>("screen", "options"),
                                  Method<&OptimizerBack>("back", "steps"),
                                  Method<&OptimizerForward>("forward", "steps"),
                                  Query<&OptimizerFork>("fork", "options"),
                                  Method<&OptimizerSet>("set", "options"),
                                  Method<&OptimizerSetNominal>("set_nominal", "number"),
                                  Query<&OptimizerRollouts>("rollouts"),
                                  Query<&OptimizerElite>("elite", "count"),
                                  Query<&OptimizerRollout>("rollout", "number"),
                                  Query<&OptimizerTrace>("trace", "number, every"),
                                  Query<&OptimizerWhy>("why", "number"),
                                  Query<&OptimizerWhyNot>("why_not", "number, other"),
                                  Method<&OptimizerCertify>("certify", "options, plan"),
                                  Method<&OptimizerShot>("shot", "options"),
                              },
                              {
                                  Property<&OptimizerIteration>("iteration"),
                                  Property<&OptimizerBestCost>("best_cost"),
                                  Property<&OptimizerMeanCost>("mean_cost"),
                                  Property<&OptimizerScoreScale>("score_scale"),
                                  Property<&OptimizerBest>("best"),
                                  Property<&OptimizerNominal>("nominal"),
                                  Property<&OptimizerPlans>("plans"),
                                  Property<&OptimizerSigma>("sigma"),
                                  Property<&OptimizerSettings>("settings"),
                                  Property<&OptimizerConverged>("converged"),
                                  Property<&OptimizerBestHistory>("best_history"),
                                  Property<&OptimizerMeanHistory>("mean_history"),
                                  Property<&OptimizerRank>("path_rank"),
                                  Property<&OptimizerStepId>("step_id"),
                              },
                              OptimizerToString};
  return info;
}

const ClassInfo& TrajectoryClass() {
  static const ClassInfo info{"Trajectory",
                              {
                                  Method<&TrajectoryGrasps>("grasps", "options"),
                                  Query<&TrajectoryWhy>("why"),
                                  Query<&TrajectoryWhyNot>("why_not", "other"),
                                  Query<&TrajectoryTrace>("trace", "every"),
                                  Query<&TrajectoryBody>("body", "name"),
                                  Method<&TrajectoryShot>("shot", "options"),
                              },
                              {
                                  Property<&TrajectoryCertified>("certified"),
                                  Property<&TrajectoryReasons>("reasons"),
                                  Property<&TrajectorySlow>("slow"),
                                  Property<&TrajectoryHoldShift>("hold_shift_mm"),
                                  Property<&TrajectoryHoldTurn>("hold_turn_deg"),
                                  Property<&TrajectoryStepShift>("step_shift_mm"),
                                  Property<&TrajectoryStepTurn>("step_turn_deg"),
                                  Property<&TrajectoryPenetration>("max_penetration_mm"),
                                  Property<&TrajectoryNotConverged>("not_converged"),
                                  Property<&TrajectoryUnresolved>("unresolved_mm"),
                                  Property<&TrajectoryTipOverlap>("max_tip_overlap_mm"),
                                  Property<&TrajectoryMaxSpeed>("max_speed"),
                                  Property<&TrajectoryMaxForce>("max_force_N"),
                                  Property<&TrajectorySeconds>("seconds"),
                                  Property<&TrajectoryWaits>("waits"),
                                  Property<&TrajectoryOutOfReach>("out_of_reach_t"),
                                  Property<&TrajectoryNeighbours>("neighbours"),
                                  Property<&TrajectoryRobust>("robust"),
                                  Property<&TrajectorySteps>("num_steps"),
                                  Property<&TrajectoryStays>("stays_when_released"),
                                  Property<&TrajectoryReleasedShift>("released_shift_mm"),
                                  Property<&TrajectoryReleasedTurn>("released_turn_deg"),
                                  Property<&TrajectoryPressing>("pressing"),
                                  Property<&TrajectoryStages>("stages"),
                                  Property<&TrajectoryObject>("object"),
                                  Property<&TrajectoryStepId>("step_id"),
                              },
                              TrajectoryToString};
  return info;
}

std::vector<const Schema*> TrajectorySchemas() {
  return {&kCostTerms, &kScreening, &kNeighbours, &kRobustness, &kPlanStage, &kPlanFinger};
}

PlanChoice LuaValue<PlanChoice>::Read(lua_State* L, int index, const std::string& path) {
  index = lua_absindex(L, index);
  PlanChoice choice;
  if (lua_type(L, index) == LUA_TNUMBER) {
    const int plan = LuaValue<int>::Read(L, index, path);
    if (plan != 1) choice.options["plan"] = plan;
    return choice;
  }
  const int count = CheckList(L, index, path, "a plan's number or a list of stages");
  nlohmann::json stages = nlohmann::json::array();
  for (int i = 1; i <= count; ++i) {
    lua_rawgeti(L, index, i);
    const std::string field = fmt::format("{}[{}]", path, i);
    if (!lua_istable(L, -1))
      throw InputError("", field, "a table of fingers", DescribeValue(L, -1));
    stages.push_back(ReadPlanStage(L, -1, field));
    lua_pop(L, 1);
  }
  choice.options["stages"] = std::move(stages);
  return choice;
}

}  // namespace pregrasp
