#include <fmt/format.h>

#include "bindings/lua_grasp.h"
#include "bindings/lua_planner.h"

namespace pregrasp {
namespace {

const Schema kCostTerms{"CostTerms",
                        {"total", "stage_scores", "final_score", "no_contact", "slip", "effort",
                         "unrest", "speed", "tip_overlap", "tip_spacing", "fall"}};
const Schema kRollout{"Rollout", {"cost", "weight", "terms", "X_WO"}};
const Schema kPlanStage{"PlanStage", {"thumb", "index"}};
const Schema kPlanFinger{"PlanFinger", {"on", "kept", "p_OC", "nhat_O", "p_WTargets"}};

constexpr int kIterationKib = 100;
constexpr int kTrajectoryKib = 3000;

void PushCost(lua_State* L, const PlanCost& cost) {
  RecordWriter(L, kCostTerms)
      .Set("total", cost.total)
      .Set("stage_scores", cost.stage_scores)
      .Set("final_score", cost.final_score)
      .Set("no_contact", cost.no_contact)
      .Set("slip", cost.slip)
      .Set("effort", cost.effort)
      .Set("unrest", cost.unrest)
      .Set("speed", cost.speed)
      .Set("tip_overlap", cost.tip_overlap)
      .Set("tip_spacing", cost.tip_spacing)
      .Set("fall", cost.fall);
}

// The optimiser.

std::shared_ptr<const Mppi> MakeMppi(const Planning& planning, const PlannerConfig& config,
                                     const Moment<ContactGraph>& graph, const ContactPath& path) {
  config.Validate();
  return std::make_shared<const Mppi>(planning.planner.MakeMppi(graph.state, path, config.mppi));
}

bool OptimizerStep(lua_State* L, LuaOptimizer& optimizer) {
  if (optimizer.state().ended()) return false;
  Planning& planning = *optimizer.planning;
  MppiState next = optimizer.state();
  planning.record.Time("trajectory", [&] { optimizer.mppi->Step(next, planning.planner.pool()); });
  auto step = planning.Record(
      optimizer.config, [&](PlanRecord& record) { record.AddIteration(*optimizer.mppi, next); });
  optimizer.past.push_back(std::make_shared<const Moment<MppiState>>(
      Moment<MppiState>{std::move(next), std::move(step)}));
  CountMemory(L, kIterationKib);
  return true;
}

void OptimizerBack(LuaOptimizer& optimizer, const std::optional<int>& steps) {
  GoBack(optimizer.past, steps.value_or(1));
}

Pushed OptimizerFork(lua_State* L, LuaOptimizer& optimizer, const OptimizeOptions& options) {
  auto fork = std::make_shared<LuaOptimizer>(optimizer);
  options.ApplyTo(fork->config);
  fork->mppi =
      MakeMppi(*fork->planning, fork->config, *fork->graph, optimizer.mppi->problem().path);
  if (fork->mppi->Start().mean.size() != optimizer.state().mean.size()) {
    throw InputError("", "knots",
                     std::to_string(optimizer.config.mppi.timing.knots) + ", as before",
                     std::to_string(fork->config.mppi.timing.knots));
  }
  PushObject(L, std::move(fork));
  return {1};
}

Pushed OptimizerRollouts(lua_State* L, LuaOptimizer& optimizer) {
  const std::vector<MppiSample>& samples = optimizer.state().samples;
  lua_createtable(L, static_cast<int>(samples.size()), 0);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    RecordWriter rollout(L, kRollout);
    rollout.Set("cost", samples[i].cost.total).Set("weight", samples[i].weight);
    PushCost(L, samples[i].cost);
    rollout.SetTop("terms");
    PushTransform(L, samples[i].X_WO_end);
    rollout.SetTop("X_WO");
    lua_rawseti(L, -2, static_cast<lua_Integer>(i) + 1);
  }
  return {1};
}

Pushed OptimizerCertify(lua_State* L, LuaOptimizer& optimizer, const CertifyOptions& options) {
  if (optimizer.state().best_action.empty()) {
    throw InputError("", "", "at least one step()", "none");
  }
  PlannerConfig config = optimizer.config;
  options.ApplyTo(config);
  Planning& planning = *optimizer.planning;
  const Planner planner = planning.planner.WithConfig(config);
  Certificate certificate;
  ReleaseResult release;
  planning.record.Time("trajectory", [&] {
    certificate = planner.Certify(*optimizer.mppi, optimizer.state());
    release = planner.Release(optimizer.graph->state, certificate);
  });
  auto step = planning.Record(config, [&](PlanRecord& record) {
    record.AddCertificate(*optimizer.mppi, certificate, release);
    record.ChoosePath(*optimizer.mppi, certificate, release, {});
  });
  PushObject(L, std::make_shared<LuaTrajectory>(
                    LuaTrajectory{optimizer.planning, config, optimizer.graph, optimizer.mppi,
                                  std::move(certificate), std::move(release), std::move(step)}));
  CountMemory(L, kTrajectoryKib);
  return {1};
}

void OptimizerShot(lua_State* L, LuaOptimizer& optimizer, const ShotOptions& options) {
  ShootStep(L, *optimizer.planning, optimizer.past.back()->step, options);
}

int OptimizerIteration(LuaOptimizer& optimizer) { return optimizer.state().iteration; }
// nil before the first iteration
std::optional<double> OptimizerBestCost(LuaOptimizer& optimizer) {
  if (optimizer.state().iteration == 0) return std::nullopt;
  return optimizer.state().best_cost;
}
std::optional<double> OptimizerMeanCost(LuaOptimizer& optimizer) {
  if (optimizer.state().iteration == 0) return std::nullopt;
  return optimizer.state().mean_history.back();
}
Pushed OptimizerBest(lua_State* L, LuaOptimizer& optimizer) {
  PushCost(L, optimizer.state().best);
  return {1};
}
bool OptimizerConverged(LuaOptimizer& optimizer) { return optimizer.state().converged(); }
std::vector<double> OptimizerBestHistory(LuaOptimizer& optimizer) {
  return optimizer.state().best_history;
}
std::vector<double> OptimizerMeanHistory(LuaOptimizer& optimizer) {
  return optimizer.state().mean_history;
}
int OptimizerRank(LuaOptimizer& optimizer) { return optimizer.mppi->problem().path.rank; }
std::string OptimizerStepId(LuaOptimizer& optimizer) { return StepId(optimizer.past.back()->step); }

int OptimizerToString(lua_State* L) {
  const auto optimizer = FindObject<LuaOptimizer>(L, 1);
  const std::string text =
      optimizer ? fmt::format("Optimizer(path {}, iteration {})",
                              optimizer->mppi->problem().path.rank, optimizer->state().iteration)
                : "Optimizer";
  lua_pushlstring(L, text.data(), text.size());
  return 1;
}

// The certified trajectory.

void TrajectoryShot(lua_State* L, LuaTrajectory& trajectory, const ShotOptions& options) {
  ShootStep(L, *trajectory.planning, trajectory.step, options);
}

Pushed TrajectoryBody(lua_State* L, LuaTrajectory& trajectory, const std::string& name) {
  const World& world = trajectory.planning->planner.world();
  PushBody(L, world, trajectory.certificate.full.end, FindBody(world.scene(), name));
  return {1};
}

bool TrajectoryCertified(LuaTrajectory& trajectory) { return trajectory.certificate.certified; }
std::vector<std::string> TrajectoryReasons(LuaTrajectory& trajectory) {
  std::vector<std::string> reasons;
  for (const CertifyReason reason : trajectory.certificate.reasons) {
    reasons.emplace_back(CertifyReasonText(reason));
  }
  return reasons;
}
double TrajectoryHoldShift(LuaTrajectory& t) { return 1e3 * t.certificate.hold_shift; }
double TrajectoryHoldTurn(LuaTrajectory& t) { return t.certificate.hold_turn_deg; }
double TrajectoryStepShift(LuaTrajectory& t) { return 1e3 * t.certificate.step_shift; }
double TrajectoryStepTurn(LuaTrajectory& t) { return t.certificate.step_turn_deg; }
double TrajectoryPenetration(LuaTrajectory& t) { return 1e3 * t.certificate.full.max_penetration; }
double TrajectoryTipOverlap(LuaTrajectory& t) { return 1e3 * t.certificate.full.max_tip_overlap; }
double TrajectoryMaxSpeed(LuaTrajectory& t) { return t.certificate.full.max_speed; }
double TrajectoryMaxForce(LuaTrajectory& t) { return t.certificate.full.max_force; }
double TrajectorySeconds(LuaTrajectory& t) { return t.certificate.full.seconds; }
int TrajectorySteps(LuaTrajectory& t) { return static_cast<int>(t.certificate.trace.size()) - 1; }
bool TrajectoryStays(LuaTrajectory& t) { return t.release.stays; }
double TrajectoryReleasedShift(LuaTrajectory& t) { return 1e3 * t.release.shift; }
double TrajectoryReleasedTurn(LuaTrajectory& t) { return t.release.turn_deg; }
std::string TrajectoryStepId(LuaTrajectory& trajectory) { return StepId(trajectory.step); }

Pushed TrajectoryPressing(lua_State* L, LuaTrajectory& trajectory) {
  PushGraspContacts(L, trajectory.release.pressing);
  return {1};
}

Pushed TrajectoryObject(lua_State* L, LuaTrajectory& trajectory) {
  PushBody(L, trajectory.planning->planner.world(), trajectory.certificate.full.end, 0);
  return {1};
}

Pushed TrajectoryStages(lua_State* L, LuaTrajectory& trajectory) {
  const auto& stages = trajectory.certificate.full.plan.stages;
  lua_createtable(L, static_cast<int>(stages.size()), 0);
  for (std::size_t i = 0; i < stages.size(); ++i) {
    RecordWriter stage(L, kPlanStage);
    for (int f = 0; f < kNumPlanningFingers; ++f) {
      const WorldPlan::Finger& finger = stages[i][static_cast<std::size_t>(f)];
      RecordWriter(L, kPlanFinger)
          .Set("on", finger.on)
          .Set("kept", finger.kept)
          .Set("p_OC", finger.contact.p_OC)
          .Set("nhat_O", finger.contact.nhat_O)
          .Set("p_WTargets", finger.p_WTargets);
      stage.SetTop(kFingerNames[f]);
    }
    lua_rawseti(L, -2, static_cast<lua_Integer>(i) + 1);
  }
  return {1};
}

int TrajectoryToString(lua_State* L) {
  const auto trajectory = FindObject<LuaTrajectory>(L, 1);
  const std::string text =
      trajectory ? fmt::format("Trajectory(path {}, {})", trajectory->path_rank(),
                               trajectory->certificate.certified ? "certified" : "not certified")
                 : "Trajectory";
  lua_pushlstring(L, text.data(), text.size());
  return 1;
}

}  // namespace

Pushed PathOptimize(lua_State* L, LuaPath& path, const OptimizeOptions& options) {
  PlannerConfig config = path.config;
  options.ApplyTo(config);
  auto mppi = MakeMppi(*path.planning, config, *path.graph, path.path);
  Moments<MppiState> past = {
      std::make_shared<const Moment<MppiState>>(Moment<MppiState>{mppi->Start(), path.step})};
  PushObject(L, std::make_shared<LuaOptimizer>(LuaOptimizer{path.planning, config, path.graph,
                                                            std::move(mppi), std::move(past)}));
  return {1};
}

const ClassInfo& OptimizerClass() {
  static const ClassInfo info{"Optimizer",
                              {
                                  Method<&OptimizerStep>("step"),
                                  Method<&OptimizerBack>("back", "steps"),
                                  Method<&OptimizerFork>("fork", "options"),
                                  Method<&OptimizerRollouts>("rollouts"),
                                  Method<&OptimizerCertify>("certify", "options"),
                                  Method<&OptimizerShot>("shot", "options"),
                              },
                              {
                                  Property<&OptimizerIteration>("iteration"),
                                  Property<&OptimizerBestCost>("best_cost"),
                                  Property<&OptimizerMeanCost>("mean_cost"),
                                  Property<&OptimizerBest>("best"),
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
                                  Method<&TrajectoryBody>("body", "name"),
                                  Method<&TrajectoryShot>("shot", "options"),
                              },
                              {
                                  Property<&TrajectoryCertified>("certified"),
                                  Property<&TrajectoryReasons>("reasons"),
                                  Property<&TrajectoryHoldShift>("hold_shift_mm"),
                                  Property<&TrajectoryHoldTurn>("hold_turn_deg"),
                                  Property<&TrajectoryStepShift>("step_shift_mm"),
                                  Property<&TrajectoryStepTurn>("step_turn_deg"),
                                  Property<&TrajectoryPenetration>("max_penetration_mm"),
                                  Property<&TrajectoryTipOverlap>("max_tip_overlap_mm"),
                                  Property<&TrajectoryMaxSpeed>("max_speed"),
                                  Property<&TrajectoryMaxForce>("max_force_N"),
                                  Property<&TrajectorySeconds>("seconds"),
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
  return {&kCostTerms, &kRollout, &kPlanStage, &kPlanFinger};
}

}  // namespace pregrasp
