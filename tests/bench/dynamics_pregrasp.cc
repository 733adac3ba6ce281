#include <chrono>
#include <ctime>

#include "app/core/thread_pool.h"
#include "app/dynamics/world.h"
#include "tests/bench/dynamics_scenes.h"

namespace pregrasp {
namespace {

WorldState StartOf(const World& world, const DynamicsCase& c) {
  WorldState state = world.InitialState();
  if (c.finger) world.PutFinger(state, Finger::kIndex, c.p_OC);
  return state;
}

// The case's two seconds, the finger's target going `share` of the way. Returns the steps.
int Run(const World& world, const DynamicsCase& c, double share, WorldState* state) {
  FingertipState& finger = state->fingers[static_cast<int>(Finger::kIndex)];
  const Vector3 p_WC = finger.p_WTarget;
  const int steps = static_cast<int>(std::lround(DynamicsCase::kSeconds / world.config().dt));
  for (int i = 1; i <= steps; ++i) {
    if (c.finger) {
      finger.p_WTarget = p_WC + share * (c.TargetAt(i * world.config().dt, p_WC) - p_WC);
    }
    world.Step(*state);
  }
  return steps;
}

}  // namespace

EngineRun RunPregrasp(const DynamicsCase& c) {
  const World world(c.scene);
  WorldState state = StartOf(world, c);
  EngineRun run;
  const double start = ThreadCpuSeconds();
  run.steps = Run(world, c, 1.0, &state);
  run.cpu_seconds = ThreadCpuSeconds() - start;
  run.X_WO = state.bodies[0].X_WB();
  return run;
}

BatchRun RunPregraspBatch(const DynamicsCase& c, int threads) {
  constexpr int kNumRollouts = 256;
  const World world(c.scene);
  ThreadPool pool(threads);
  const WorldState start_state = StartOf(world, c);
  BatchRun run;
  run.p_WO.resize(kNumRollouts);
  const auto roll_out = [&](int i, int) {
    WorldState state = start_state;
    Run(world, c, 0.5 + 0.5 * i / kNumRollouts, &state);
    run.p_WO[i] = state.bodies[0].p_WB;
  };
  pool.ParallelFor(kNumRollouts, roll_out);  // every thread's memory grows
  const std::clock_t cpu_start = std::clock();
  const auto start = std::chrono::steady_clock::now();
  pool.ParallelFor(kNumRollouts, roll_out);
  run.wall_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  run.cpu_seconds = static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC;
  return run;
}

}  // namespace pregrasp
