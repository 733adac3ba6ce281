// Rollout/SCENE/ENGINE: two simulated seconds of contact, beside the engines that people know.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "tests/bench/dynamics_scenes.h"

namespace pregrasp {
namespace {

constexpr std::array<const char*, 4> kEngines = {"pregrasp", "bullet10", "bullet50", "mujoco"};
constexpr int kRepetitions = 9;

EngineRun RunEngine(const DynamicsCase& c, std::size_t engine) {
  switch (engine) {
    case 0:
      return RunPregrasp(c);
    case 1:
      return RunBullet(c, 10);
    case 2:
      return RunBullet(c, 50);
    default:
      return RunMujoco(c);
  }
}

// The fastest of several runs of each engine, taken in turns so that a busy moment hits all alike.
std::array<EngineRun, kEngines.size()> Measure(const DynamicsCase& c) {
  std::array<EngineRun, kEngines.size()> best;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    for (std::size_t engine = 0; engine < kEngines.size(); ++engine) {
      const EngineRun run = RunEngine(c, engine);
      if (repetition == 0 || run.cpu_seconds < best[engine].cpu_seconds) best[engine] = run;
    }
  }
  return best;
}

void Rollout(benchmark::State& state, const DynamicsCase& c, std::size_t engine) {
  static std::map<std::string, std::array<EngineRun, kEngines.size()>> measured;
  if (measured.count(c.name) == 0) measured[c.name] = Measure(c);
  const auto& runs = measured[c.name];
  for (auto _ : state) state.SetIterationTime(runs[engine].cpu_seconds);

  const EngineRun& run = runs[engine];
  state.counters["us_per_step"] = 1e6 * run.cpu_seconds / run.steps;
  state.counters["realtime_factor"] = DynamicsCase::kSeconds / run.cpu_seconds;
  for (std::size_t other = 0; other < kEngines.size(); ++other) {
    if (other == engine) continue;
    state.counters[std::string("time_over_") + kEngines[other]] =
        run.cpu_seconds / runs[other].cpu_seconds;
  }
  const double value = c.measure(run.X_WO);
  state.counters[c.quantity] = value;
  const bool valid = std::isfinite(value) && std::abs(value - c.expected) <= c.tolerance;
  state.SetLabel(fmt::format("{}{} {:.3g}, expected {:.3g} +- {:.2g}",
                             valid ? "" : "INVALID: ", c.quantity, value, c.expected, c.tolerance));
}

}  // namespace
}  // namespace pregrasp

int main(int argc, char** argv) {
  using namespace pregrasp;
  for (const DynamicsCase& c : MakeDynamicsCases()) {
    for (std::size_t engine = 0; engine < kEngines.size(); ++engine) {
      const std::string name = std::string("Rollout/") + c.name + "/" + kEngines[engine];
      benchmark::RegisterBenchmark(
          name.c_str(), [c, engine](benchmark::State& state) { Rollout(state, c, engine); })
          ->UseManualTime()
          ->Iterations(1)
          ->Unit(benchmark::kMillisecond);
    }
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
