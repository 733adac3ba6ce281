// The same bytes for any number of threads.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "app/core/sha256.h"
#include "app/core/thread_pool.h"
#include "app/dynamics/world.h"
#include "tests/dynamics/scenes.h"

namespace pregrasp {
namespace {

World MakeCrowdedWorld() {
  return World(MakeScene(
      MakeMovable("plate", MakePlateUnion(), At(0, 0, 0), 0.5, 0.3),
      {MakeTable(), MakeMovable("bottle", Cylinder{0.03, 0.2}, At(0.17, 0, 0.1), 0.5, 0.3),
       MakeMovable("hook", MakeHook(), At(-0.2, 0.05, 0.03), 0.2, 0.4),
       MakeMovable("cup", testing::MakeMesh(testing::MakeCup(0.04, 0.08, 0.004, 24)),
                   At(0.02, 0.2, 0), 0.2, 0.4)}));
}

// A rollout of its own for each `i`: two fingers push the plate's rim, their targets going on
// straight lines in directions of their own.
WorldState StartPush(const World& world, int i, std::array<Vector3, kNumPlanningFingers>* v_W) {
  Rng rng(i);
  WorldState state = world.InitialState();
  for (int f = 0; f < kNumPlanningFingers; ++f) {
    const double angle = rng.Uniform(0.0, 2.0 * kPi);
    world.PutFinger(state, static_cast<Finger>(f),
                    Vector3(0.13 * std::cos(angle), 0.13 * std::sin(angle), 0.02));
    (*v_W)[f] = 0.2 * rng.Direction();
  }
  return state;
}

template <typename Step>
WorldState Push(const World& world, int i, int steps, const Step& step) {
  std::array<Vector3, kNumPlanningFingers> v_W;
  WorldState state = StartPush(world, i, &v_W);
  for (int k = 0; k < steps; ++k) {
    for (int f = 0; f < kNumPlanningFingers; ++f) {
      state.fingers[f].p_WTarget += world.config().dt * v_W[f];
    }
    step(&state);
  }
  return state;
}

// Of the ends of `count` rollouts.
template <typename Step>
std::string HashBatch(const World& world, int count, int steps, int threads, const Step& step) {
  std::vector<std::string> bytes(count);
  ThreadPool(threads).ParallelFor(
      count, [&](int i, int) { bytes[i] = BytesOf(Push(world, i, steps, step)); });
  return Sha256(std::accumulate(bytes.begin(), bytes.end(), std::string()));
}

// Positions and rotations to 0.1 um and 0.1 urad: another processor's last bits do not show, what
// changes the physics does.
std::string RoundedEnds(const World& world, int count, int steps, int threads) {
  std::vector<std::string> texts(count);
  ThreadPool(threads).ParallelFor(count, [&](int i, int) {
    const WorldState end = Push(world, i, steps, [&](WorldState* state) { world.Step(*state); });
    const auto add = [&](double value) {
      texts[i] += std::to_string(std::llround(1e7 * value)) + " ";
    };
    for (const BodyState& body : end.bodies) {
      for (int k = 0; k < 3; ++k) add(body.p_WB[k]);
      for (int k = 0; k < 4; ++k) add(body.q_WB.coeffs()[k]);
    }
  });
  return std::accumulate(texts.begin(), texts.end(), std::string());
}

TEST(DeterminismTest, AfterAQuarterSecondTheStateIsThePinnedOneForOneTwoAndFourThreads) {
  // A wanted change of the physics changes it: then take the new value from the failure.
  const std::string pinned = "09a33487a0e411ddb40079d00856927ae0c0c92cae89a6138d94eb0ea545255d";
  const World world = MakeCrowdedWorld();
  for (const int threads : {1, 2, 4}) {
    EXPECT_EQ(Sha256(RoundedEnds(world, 6, 60, threads)), pinned) << threads;
  }
}

TEST(DeterminismTest, ABatchOfRolloutsHasTheSameHashOnOneTwoAndFourThreads) {
  const World world = MakeCrowdedWorld();
  const auto step = [&](WorldState* state) { world.Step(*state); };
  const std::string hash = HashBatch(world, 12, 240, 1, step);
  EXPECT_EQ(HashBatch(world, 12, 240, 2, step), hash);
  EXPECT_EQ(HashBatch(world, 12, 240, 4, step), hash);
  // The hash tells one rollout from another.
  EXPECT_NE(HashBatch(world, 11, 240, 4, step), hash);
  EXPECT_NE(HashBatch(world, 12, 239, 4, step), hash);
}

TEST(DeterminismTest, AWorldBuiltAgainStepsToTheSameBytes) {
  std::string first;
  for (int i = 0; i < 2; ++i) {
    const World world = MakeCrowdedWorld();
    const auto step = [&](WorldState* state) { world.Step(*state); };
    const std::string bytes = BytesOf(Push(world, 0, 120, step));
    if (i == 0) first = bytes;
    EXPECT_EQ(bytes, first);
  }
}

TEST(DeterminismTest, TheSimbodyStepperHasTheSameHashOnOneTwoAndFourThreads) {
  const World world = MakeCrowdedWorld();
  const auto step = [&](WorldState* state) { world.StepWithSimbody(*state); };
  const std::string hash = HashBatch(world, 4, 60, 1, step);
  EXPECT_EQ(HashBatch(world, 4, 60, 2, step), hash);
  EXPECT_EQ(HashBatch(world, 4, 60, 4, step), hash);
}

}  // namespace
}  // namespace pregrasp
