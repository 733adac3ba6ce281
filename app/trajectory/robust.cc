#include "app/trajectory/robust.h"

#include <algorithm>
#include <cmath>

#include "app/core/check.h"

namespace pregrasp {
namespace {

void ScaleFriction(Scene& scene, double factor) {
  for (Body& body : scene.bodies) body.friction *= factor;
}

void ScaleMass(Scene& scene, double factor) {
  MassProperties& mass = *scene.object().mass_properties;
  mass.mass *= factor;
  mass.I_BBcm *= factor;
}

}  // namespace

const char* RobustChangeName(RobustChange change) {
  constexpr const char* kNames[kNumRobustChanges] = {"friction x 0.75", "friction x 1.25",
                                                     "mass x 0.7", "mass x 1.3", "spread support"};
  return kNames[static_cast<int>(change)];
}

Scene ChangeScene(const Scene& scene, RobustChange change) {
  Scene changed = scene;
  switch (change) {
    case RobustChange::kLessFriction:
      ScaleFriction(changed, 0.75);
      break;
    case RobustChange::kMoreFriction:
      ScaleFriction(changed, 1.25);
      break;
    case RobustChange::kLighter:
      ScaleMass(changed, 0.7);
      break;
    case RobustChange::kHeavier:
      ScaleMass(changed, 1.3);
      break;
    case RobustChange::kSpreadSupport:
      break;
  }
  return changed;
}

std::vector<World> MakeExtremeWorlds(const Scene& scene, const StepConfig& config) {
  using enum RobustChange;
  std::vector<World> worlds;
  worlds.emplace_back(ChangeScene(ChangeScene(scene, kLighter), kLessFriction), config);
  worlds.emplace_back(ChangeScene(ChangeScene(scene, kHeavier), kMoreFriction), config);
  return worlds;
}

RobustWorlds::RobustWorlds(const Scene& scene, const StepConfig& config) {
  for (int i = 0; i < kNumRobustChanges; ++i) {
    const auto change = static_cast<RobustChange>(i);
    StepConfig step = config;
    step.spread_support = config.spread_support || change == RobustChange::kSpreadSupport;
    worlds_.emplace_back(ChangeScene(scene, change), step);
  }
}

RobustResult RobustWorlds::Test(const EnvironmentDistance& environment, const WorldState& start,
                                const WorldPlan& plan, PlanTiming timing,
                                const CertifyConfig& config, const WorldState& nominal_end) const {
  timing = CertifyTiming(timing, config);
  RobustResult result;
  for (std::size_t i = 0; i < worlds_.size(); ++i) {
    const PlanOutcome run =
        SimulatePlan(worlds_[i], environment, start, plan, timing, Stepper::kKernel);
    RobustOutcome outcome;
    outcome.change = static_cast<RobustChange>(i);
    CalcShift(nominal_end, run.end, &outcome.shift, &outcome.turn_deg);
    PREGRASP_CHECK(std::isfinite(outcome.shift) && std::isfinite(outcome.turn_deg));
    outcome.held = !run.diverged && StaysInHold(run, config) && outcome.shift <= kRobustShift &&
                   outcome.turn_deg <= kRobustTurnDeg;
    result.held += outcome.held;
    result.worst_shift = std::max(result.worst_shift, outcome.shift);
    result.worst_turn_deg = std::max(result.worst_turn_deg, outcome.turn_deg);
    result.outcomes.push_back(outcome);
  }
  return result;
}

}  // namespace pregrasp
