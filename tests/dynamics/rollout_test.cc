#include "app/dynamics/rollout.h"

#include <gtest/gtest.h>

#include <vector>

#include "app/core/error.h"
#include "tests/dynamics/scenes.h"

namespace pregrasp {
namespace {

World MakeBoxWorld() {
  return World(MakeScene(MakeBox("box", Vector3(0.1, 0.08, 0.06), At(0, 0, 0.03), 0.3, 0.3)));
}

RolloutInput MakePush(const World& world, const Vector3& travel) {
  RolloutInput input;
  input.start = world.InitialState();
  world.PutFinger(input.start, Finger::kIndex, Vector3(-0.05, 0.0, 0.0));
  input.p_WTargets[kIndex] = {input.start.fingers[kIndex].p_WTarget + travel};
  return input;
}

TEST(RolloutTest, KnotsAreReachedOnStraightLinesAndTheLastStays) {
  const World world = MakeBoxWorld();
  RolloutInput input = MakePush(world, Vector3(0.04, 0, 0));
  const Vector3 start = input.start.fingers[kIndex].p_WTarget;
  input.p_WTargets[kIndex].push_back(start + Vector3(0.04, 0.02, 0));
  RolloutConfig config;
  config.steps = 12;
  config.steps_per_knot = 4;
  config.record_every = 1;
  const RolloutResult result = SimulateRollout(world, config, input);
  ASSERT_EQ(result.record.size(), 12U);
  const auto offset = [&](int step) -> Vector3 {
    return result.record[step - 1].fingers[kIndex].p_WTarget - start;
  };
  EXPECT_LT((offset(1) - Vector3(0.01, 0, 0)).norm(), 1e-15);
  EXPECT_LT((offset(4) - Vector3(0.04, 0, 0)).norm(), 1e-15);
  EXPECT_LT((offset(6) - Vector3(0.04, 0.01, 0)).norm(), 1e-15);
  EXPECT_LT((offset(8) - Vector3(0.04, 0.02, 0)).norm(), 1e-15);
  EXPECT_LT((offset(12) - Vector3(0.04, 0.02, 0)).norm(), 1e-15);
}

TEST(RolloutTest, ARolloutIsItsStepsOneByOne) {
  const World world = MakeBoxWorld();
  const RolloutInput input = MakePush(world, Vector3(0.05, 0, 0));
  RolloutConfig config;
  config.steps = config.steps_per_knot = 100;
  const RolloutResult result = SimulateRollout(world, config, input);
  WorldState state = input.start;
  const Vector3 from = state.fingers[kIndex].p_WTarget, to = input.p_WTargets[kIndex][0];
  for (int i = 1; i <= 100; ++i) {
    state.fingers[kIndex].p_WTarget = i == 100 ? to : Vector3(from + i / 100.0 * (to - from));
    world.Step(state);
  }
  EXPECT_EQ(BytesOf(result.end), BytesOf(state));
  EXPECT_EQ(result.status, RolloutResult::Status::kFinished);
  EXPECT_GT(result.max_force, 1.0);
  EXPECT_GT(result.max_speed, 0.01);
}

TEST(RolloutTest, StopsWhenTheObjectFallsMovesTooFarOrSettles) {
  const World world(
      MakeScene(MakeBox("box", Vector3(0.1, 0.08, 0.06), At(0.9, 0, 0.03), 0.3, 0.3)));
  RolloutConfig config;
  config.steps = 960;
  config.steps_per_knot = 240;
  RolloutInput input = MakePush(world, Vector3(0.3, 0, 0));

  config.stop.min_height = -0.05;
  RolloutResult result = SimulateRollout(world, config, input);
  EXPECT_EQ(result.status, RolloutResult::Status::kFell);
  EXPECT_LT(result.end.bodies[0].p_WB.z(), -0.05);
  EXPECT_LT(result.steps, 960);

  config.stop.max_travel = 0.02;
  result = SimulateRollout(world, config, input);
  EXPECT_EQ(result.status, RolloutResult::Status::kTooFar);

  config.stop = {};
  config.stop.max_speed = 0.05;
  EXPECT_EQ(SimulateRollout(world, config, input).status, RolloutResult::Status::kTooFast);

  config.stop = {};
  config.stop.settled_steps = 24;
  input = MakePush(world, Vector3::Zero());
  result = SimulateRollout(world, config, input);
  EXPECT_EQ(result.status, RolloutResult::Status::kSettled);
  EXPECT_LT(result.steps, 60);
}

TEST(RolloutTest, AStateThatIsNotFiniteEndsTheRollout) {
  const World world = MakeBoxWorld();
  RolloutInput input;
  input.start = world.InitialState();
  input.start.bodies[0].v_WB.x() = std::nan("");
  EXPECT_EQ(SimulateRollout(world, {}, input).status, RolloutResult::Status::kNotFinite);
}

TEST(RolloutTest, BadSettingsAreRefused) {
  const World world = MakeBoxWorld();
  RolloutConfig config;
  config.steps_per_knot = 0;
  EXPECT_THROW(SimulateRollout(world, config, MakePush(world, Vector3::Zero())), InputError);
}

}  // namespace
}  // namespace pregrasp
