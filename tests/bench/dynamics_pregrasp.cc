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

}  // namespace pregrasp
