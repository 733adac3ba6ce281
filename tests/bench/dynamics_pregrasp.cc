#include <chrono>
#include <ctime>

#include "app/core/thread_pool.h"
#include "app/dynamics/rollout.h"
#include "app/dynamics/world.h"
#include "tests/bench/dynamics_scenes.h"

namespace pregrasp {

EngineRun RunPregrasp(const DynamicsCase& c) {
  const World world(c.scene);
  WorldState state = world.InitialState();
  if (c.finger) world.PutFinger(state, Finger::kIndex, c.p_OC);
  FingertipState& finger = state.fingers[static_cast<int>(Finger::kIndex)];
  const Vector3 p_WC_start = finger.p_WTarget;
  EngineRun run;
  run.steps = static_cast<int>(std::lround(DynamicsCase::kSeconds / world.config().dt));
  const double start = ThreadCpuSeconds();
  for (int i = 0; i < run.steps; ++i) {
    if (c.finger) finger.p_WTarget = c.TargetAt((i + 1) * world.config().dt, p_WC_start);
    world.Step(state);
  }
  run.cpu_seconds = ThreadCpuSeconds() - start;
  run.X_WO = state.bodies[0].X_WB();
  return run;
}

BatchRun RunPregraspBatch(const DynamicsCase& c, int threads) {
  constexpr int kNumRollouts = 256, kNumKnots = 20;
  const World world(c.scene);
  ThreadPool pool(threads);
  RolloutConfig config;
  config.steps = static_cast<int>(DynamicsCase::kSeconds / world.config().dt);
  config.steps_per_knot = config.steps / kNumKnots;
  RolloutInput input;
  input.start = world.InitialState();
  world.PutFinger(input.start, Finger::kIndex, c.p_OC);
  const int index = static_cast<int>(Finger::kIndex);
  const Vector3 p_WC = input.start.fingers[index].p_WTarget;
  std::vector<RolloutInput> inputs;
  for (int i = 0; i < kNumRollouts; ++i) {
    const double share = 0.5 + 0.5 * i / kNumRollouts;  // of the way
    input.p_WTargets[index].clear();
    for (int k = 1; k <= kNumKnots; ++k) {
      const Vector3 p_WTarget = c.TargetAt(DynamicsCase::kSeconds * k / kNumKnots, p_WC);
      input.p_WTargets[index].push_back(p_WC + share * (p_WTarget - p_WC));
    }
    inputs.push_back(input);
  }
  SimulateRollouts(world, config, inputs, &pool);  // every thread's memory grows
  BatchRun run;
  const std::clock_t cpu_start = std::clock();
  const auto start = std::chrono::steady_clock::now();
  const std::vector<RolloutResult> results = SimulateRollouts(world, config, inputs, &pool);
  run.wall_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  run.cpu_seconds = static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC;
  for (const RolloutResult& result : results) run.p_WO.push_back(result.end.bodies[0].p_WB);
  return run;
}

}  // namespace pregrasp
