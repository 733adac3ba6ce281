// Rollout/SCENE/ENGINE: two simulated seconds of contact, beside the engines that people know.
// Batch/SCENE/threads:N: 256 such rollouts on N threads.
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
constexpr int kRunsInARow = 5;  // as a planner rolls out many, with what it needs in the caches

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

// The fastest of several runs of each engine, a few in a row, taken in turns so that a busy moment
// hits all alike.
std::array<EngineRun, kEngines.size()> Measure(const DynamicsCase& c) {
  std::array<EngineRun, kEngines.size()> best;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    for (std::size_t engine = 0; engine < kEngines.size(); ++engine) {
      for (int i = 0; i < kRunsInARow; ++i) {
        const EngineRun run = RunEngine(c, engine);
        const bool is_first = repetition == 0 && i == 0;
        if (is_first || run.cpu_seconds < best[engine].cpu_seconds) best[engine] = run;
      }
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

// `speedup` needs a machine that does nothing else; `cpu_over_1`, the processor time over that of
// one thread, tells what the threads cost each other on any machine.
void Batch(benchmark::State& state, const DynamicsCase& c, int threads) {
  BatchRun one, many;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    const BatchRun run_one = RunPregraspBatch(c, 1), run_many = RunPregraspBatch(c, threads);
    if (repetition == 0 || run_one.wall_seconds < one.wall_seconds) one = run_one;
    if (repetition == 0 || run_many.wall_seconds < many.wall_seconds) many = run_many;
  }
  for (auto _ : state) state.SetIterationTime(many.wall_seconds);
  state.counters["speedup"] = one.wall_seconds / many.wall_seconds;
  state.counters["cpu_over_1"] = many.cpu_seconds / one.cpu_seconds;
  if (many.p_WO != one.p_WO) state.SetLabel("INVALID: the ends are not those of one thread");
}

}  // namespace
}  // namespace pregrasp

int main(int argc, char** argv) {
  using namespace pregrasp;
  for (const DynamicsCase& c : MakeDynamicsCases()) {
    for (std::size_t engine = 0; engine < kEngines.size(); ++engine) {
      const std::string name = fmt::format("Rollout/{}/{}", c.name, kEngines[engine]);
      benchmark::RegisterBenchmark(
          name.c_str(), [c, engine](benchmark::State& state) { Rollout(state, c, engine); })
          ->UseManualTime()
          ->Iterations(1)
          ->Unit(benchmark::kMillisecond);
    }
    if (c.name != "slot" && c.name != "shelf5") continue;
    benchmark::RegisterBenchmark(fmt::format("Batch/{}/threads:2", c.name).c_str(),
                                 [c](benchmark::State& state) { Batch(state, c, 2); })
        ->UseManualTime()
        ->Iterations(1)
        ->Unit(benchmark::kMillisecond);
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
