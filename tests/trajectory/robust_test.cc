#include "app/trajectory/robust.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/trajectory/ruler_fixture.h"

namespace pregrasp {
namespace {

TEST(RobustChangeTest, EachWorldHasOneChange) {
  const Scene scene = MakeRulerScene();
  const double mass = scene.object().mass_properties->mass;
  const double inertia = scene.object().mass_properties->I_BBcm(2, 2);
  for (int i = 0; i < kNumRobustChanges; ++i) {
    const auto change = static_cast<RobustChange>(i);
    const Scene changed = ChangeScene(scene, change);
    double friction = 1.0, heavier = 1.0;
    if (change == RobustChange::kLessFriction) friction = 0.75;
    if (change == RobustChange::kMoreFriction) friction = 1.25;
    if (change == RobustChange::kLighter) heavier = 0.7;
    if (change == RobustChange::kHeavier) heavier = 1.3;
    for (const Body& body : changed.bodies) EXPECT_DOUBLE_EQ(body.friction, 0.3 * friction);
    EXPECT_DOUBLE_EQ(changed.object().mass_properties->mass, mass * heavier);
    EXPECT_DOUBLE_EQ(changed.object().mass_properties->I_BBcm(2, 2), inertia * heavier);
    EXPECT_EQ(changed.fingertips.friction, scene.fingertips.friction);
  }
}

TEST(ExtremeWorldsTest, OneIsLightAndSlipperyTheOtherHeavyAndSticky) {
  const Scene scene = MakeRulerScene();
  const std::vector<World> worlds = MakeExtremeWorlds(scene, StepConfig());
  ASSERT_EQ(worlds.size(), 2U);
  const double mass = scene.object().mass_properties->mass;
  const auto expect = [&](const World& world, double heavier, double rougher) {
    EXPECT_DOUBLE_EQ(world.scene().object().mass_properties->mass, mass * heavier);
    for (const Body& body : world.scene().bodies) EXPECT_DOUBLE_EQ(body.friction, 0.3 * rougher);
  };
  expect(worlds[0], 0.7, 0.75);
  expect(worlds[1], 1.3, 1.25);
}

class RobustTest : public ::testing::Test {
 protected:
  RobustResult Test(const WorldPlan& plan) {
    StepConfig half;
    half.dt = ruler_.world.config().dt / 2;
    const World half_world(ruler_.scene, half);
    const WorldState start = ruler_.world.InitialState();
    certificate_ = CertifyPlan(ruler_.world, half_world, ruler_.environment, start, plan,
                               PlanTiming(), CertifyConfig());
    const RobustWorlds worlds(ruler_.scene, ruler_.world.config());
    return worlds.Test(ruler_.environment, start, plan, PlanTiming(), CertifyConfig(),
                       certificate_.full.end);
  }
  RulerProblem ruler_;
  Certificate certificate_;
};

TEST_F(RobustTest, AFirmDragEndsNearlyAlikeInEveryWorld) {
  const RobustResult result = Test(MakeRulerDrag(0.02, 0.05));
  ASSERT_TRUE(certificate_.certified);
  EXPECT_EQ(result.outcomes.size(), static_cast<std::size_t>(kNumRobustChanges));
  EXPECT_EQ(result.held, kNumRobustChanges);
  // The table's friction holds the ruler back by mu (N + weight) / k: 0.3 N each newton of it.
  const RobustOutcome& slippery = result.outcomes[0];
  EXPECT_NEAR(slippery.shift, 0.25 * 0.3 * (1.0 + 0.245) / 50.0, 4e-4);
  EXPECT_LT(slippery.turn_deg, 0.1);
}

TEST_F(RobustTest, ADragThatDependsOnFrictionEndsElsewhere) {
  // The finger presses with 0.05 N and pulls with 0.04 N at most: the nominal table holds the
  // ruler, mu 0.3 x 0.295 N, and so does every other.  A push that the table nearly holds does not
  // end alike: 0.1 N against 0.3 x (0.245 + 0.125) = 0.111 N, and against three quarters of it.
  const RobustResult still = Test(MakeRulerDrag(0.001, 0.05));
  EXPECT_EQ(still.held, kNumRobustChanges);
  const RobustResult pushed = Test(MakeRulerDrag(0.0025, 0.05));
  EXPECT_LT(pushed.held, kNumRobustChanges);
  EXPECT_FALSE(pushed.outcomes[0].held);
  EXPECT_GT(pushed.worst_shift, 0.02);
  EXPECT_EQ(pushed.worst_shift,
            std::max_element(pushed.outcomes.begin(), pushed.outcomes.end(),
                             [](const auto& a, const auto& b) { return a.shift < b.shift; })
                ->shift);
}

TEST_F(RobustTest, ARulerThatFallsOffInAWorldIsNotHeldAndItsNumbersAreFinite) {
  const RobustResult result = Test(MakeRulerDrag(0.01, 0.40));
  EXPECT_EQ(result.held, 0);
  EXPECT_TRUE(std::isfinite(result.worst_shift) && std::isfinite(result.worst_turn_deg));
}

}  // namespace
}  // namespace pregrasp
