#include "app/trajectory/certify.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/core/error.h"
#include "app/core/finite.h"
#include "app/geometry/mass_properties.h"
#include "tests/trajectory/ruler_fixture.h"

namespace pregrasp {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class CertifyTest : public ::testing::Test {
 protected:
  Certificate Certify(const WorldPlan& plan, const CertifyConfig& config = {}) {
    StepConfig half;
    half.dt = ruler_.world.config().dt / 2;
    const World half_world(ruler_.scene, half);
    return CertifyPlan(ruler_.world, half_world, ruler_.environment, ruler_.world.InitialState(),
                       plan, PlanTiming(), config);
  }
  RulerProblem ruler_;
};

TEST_F(CertifyTest, ADragThatEndsAtRestIsCertifiedAtBothSteps) {
  const Certificate result = Certify(MakeRulerDrag(0.01, 0.06));
  EXPECT_TRUE(result.certified) << CertifyReasonText(result.reasons.front());
  EXPECT_GT(result.full.end.bodies[0].p_WB.x(), -0.16 + 0.04);
  EXPECT_LT(result.step_shift, 0.002);
  EXPECT_EQ(result.hold_seconds, 1.5);
  // Every step of 0.8 s and of the 1.5 s hold, and the start.
  EXPECT_EQ(result.trace.size(), static_cast<std::size_t>(std::lround(2.3 * 240)) + 1);
}

TEST_F(CertifyTest, APlanCanBeGoneThroughMoreSlowly) {
  CertifyConfig config;
  config.slow = 2.0;
  const Certificate slow = Certify(MakeRulerDrag(0.01, 0.06), config);
  const Certificate planned = Certify(MakeRulerDrag(0.01, 0.06));
  EXPECT_TRUE(slow.certified) << CertifyReasonText(slow.reasons.front());
  // Twice 0.8 s, and a hold of 1.5 s all the same.
  EXPECT_EQ(slow.trace.size(), static_cast<std::size_t>(std::lround(3.1 * 240)) + 1);
  EXPECT_LT(slow.full.max_speed, 0.7 * planned.full.max_speed);
  EXPECT_NEAR(slow.full.end.bodies[0].p_WB.x(), planned.full.end.bodies[0].p_WB.x(), 0.01);
}

TEST_F(CertifyTest, ALimitThatIsNoNumberCertifiesNothing) {
  for (double CertifyConfig::*limit :
       {&CertifyConfig::max_hold_shift, &CertifyConfig::max_hold_turn_deg}) {
    CertifyConfig config;
    config.hold_seconds = 0.1;
    config.*limit = kNan;
    const Certificate result = Certify(MakeRulerDrag(0.01, 0.06), config);
    EXPECT_FALSE(result.certified);
    EXPECT_EQ(result.reasons.front(), CertifyReason::kDoesNotHold);
  }
}

TEST_F(CertifyTest, AHoldThatCannotBeSimulatedIsOurBug) {
  for (const double seconds : {kNan, -1.0, 1e300, std::numeric_limits<double>::infinity()}) {
    CertifyConfig config;
    config.hold_seconds = seconds;
    EXPECT_THROW(Certify(MakeRulerDrag(0.01, 0.06), config), InternalError) << seconds;
  }
}

TEST_F(CertifyTest, ATargetThatIsNoNumberIsOurBug) {
  WorldPlan plan = MakeRulerDrag(0.01, 0.06);
  plan.stages[0][1].p_WTargets[2].x() = kNan;
  EXPECT_THROW(Certify(plan), InternalError);
}

TEST_F(CertifyTest, AStateThatOverflowsDivergesAndLeavesFactsThatAreNumbers) {
  RelativePlan plan;
  plan.stages.resize(1);
  FingerStage& index = plan.stages[0][1];
  index.on = true;
  index.contact = {true, Vector3(0.0, 0.0, 0.0015), Vector3::UnitZ()};
  index.knots.resize(4);
  index.knots[1].travel_W = Vector3(1e200, 0.0, 0.0);  // its square is no number
  const PlanOutcome outcome = SimulatePlan(ruler_.world, ruler_.environment,
                                           ruler_.world.InitialState(), plan, PlanTiming());
  EXPECT_TRUE(outcome.diverged);
  EXPECT_TRUE(AreFinite(outcome.effort, outcome.max_force, outcome.max_speed, outcome.seconds,
                        outcome.end.bodies[0].p_WB, outcome.end.fingers[1].f_W));
}

// It comes from a simulation that diverged, where another one does not.
TEST_F(CertifyTest, APlanThatEndsBeforeItsStagesIsNotCertified) {
  WorldPlan plan = MakeRulerDrag(0.01, 0.06);
  plan.stages[0][1].p_WTargets.pop_back();
  const Certificate result = Certify(plan);
  EXPECT_FALSE(result.certified);
  EXPECT_EQ(result.reasons, std::vector{CertifyReason::kDiverged});
  EXPECT_GT(result.trace.size(), 100U);
}

TEST_F(CertifyTest, APlanWithoutContactIsNotCertified) {
  WorldPlan plan;
  plan.stages.resize(1);
  const Certificate result = Certify(plan);
  EXPECT_FALSE(result.certified);
  EXPECT_EQ(result.reasons.front(), CertifyReason::kNeverTouches);
}

TEST_F(CertifyTest, ARulerDraggedOffTheTableIsNotCertified) {
  const Certificate result = Certify(MakeRulerDrag(0.01, 0.40));
  EXPECT_FALSE(result.certified);
}

TEST_F(CertifyTest, AFingertipInsideTheTableIsNotCertified) {
  // Pushing the thin end face from behind, the fingertip's sphere reaches into the table.
  WorldPlan plan;
  plan.stages.resize(1);
  plan.stages[0][1].on = true;
  plan.stages[0][1].contact = {true, Vector3(-0.15, 0.0, 0.0), -Vector3::UnitX()};
  plan.stages[0][1].p_WTargets.assign(4, Vector3(-0.308, 0.0, 0.0015));
  const Certificate result = Certify(plan);
  ASSERT_FALSE(result.certified);
  EXPECT_EQ(result.reasons.front(), CertifyReason::kTipOverlap);
}

TEST_F(CertifyTest, ANeighbourThatTheObjectPushesOffTheTableIsDisturbed) {
  Scene scene = ruler_.scene;
  Body domino = scene.bodies[0];
  domino.name = "domino";  // 2 mm from the ruler's end, 8 mm from the table's edge
  domino.shape = Box{Vector3(0.006, 0.02, 0.04)};
  domino.X_WB.translation() << -0.005, 0.0, 0.02;
  domino.mass_properties = CalcMassProperties(domino.shape, 0.005);
  scene.bodies.push_back(domino);
  StepConfig half;
  half.dt = ruler_.world.config().dt / 2;
  const World world(scene), half_world(scene, half);
  const EnvironmentDistance environment(scene);
  const auto certify = [&](double way) {
    return CertifyPlan(world, half_world, environment, world.InitialState(),
                       MakeRulerDrag(0.01, way), PlanTiming(), CertifyConfig());
  };
  const NeighbourMotion pushed = certify(0.06).neighbours, left = certify(0.0).neighbours;
  EXPECT_TRUE(pushed.disturbed);
  EXPECT_GT(pushed.fell, 0.05);
  EXPECT_EQ(pushed.worst, BodyIndex{static_cast<int>(scene.bodies.size()) - 1});
  EXPECT_FALSE(left.disturbed);
  EXPECT_LT(left.moved, 1e-3);
}

// Eight boxes on each other, the object on top: hard for a solver that sweeps.
Scene MakeTower() {
  Scene scene = MakeRulerScene();
  for (int i = 0; i < 8; ++i) {
    Body box = scene.bodies[0];
    box.name = "box" + std::to_string(i);
    box.shape = Box{Vector3(0.1, 0.1, 0.1)};
    box.X_WB.translation() << -0.3, 0.0, 0.75 - 0.1 * i;
    box.mass_properties = CalcMassProperties(box.shape, 0.3);
    if (i == 0) {
      scene.bodies[0] = box;
    } else {
      scene.bodies.push_back(box);
    }
  }
  return scene;
}

// A finger presses the object's top, by a world and one of half its step that differ in nothing
// else.
Certificate CertifyPress(StepConfig config) {
  const Scene scene = MakeTower();
  const World world(scene, config);
  config.dt /= 2;
  const World half_world(scene, config);
  const EnvironmentDistance environment(scene);
  WorldPlan plan;
  plan.stages.resize(1);
  plan.stages[0][1].on = true;
  plan.stages[0][1].contact = {true, Vector3(0.0, 0.0, 0.05), Vector3::UnitZ()};
  plan.stages[0][1].p_WTargets.assign(4, Vector3(-0.3, 0.0, 0.78));
  return CertifyPlan(world, half_world, environment, world.InitialState(), plan, PlanTiming(),
                     CertifyConfig());
}

TEST(CertifyConvergenceTest, APlanWhoseContactForcesWereNotFoundIsNotCertified) {
  StepConfig config;
  config.max_sweeps_many = 3;
  const Certificate result = CertifyPress(config);
  EXPECT_FALSE(result.certified);
  EXPECT_EQ(std::count(result.reasons.begin(), result.reasons.end(), CertifyReason::kNotConverged),
            1);
  EXPECT_GT(result.full.unresolved, 1e-3);
  EXPECT_GT(result.full.max_residual, 0.0);
  EXPECT_LE(result.full.unresolved,
            result.full.max_residual * result.full.not_converged * config.dt);
  EXPECT_GT(result.full.not_converged, 0);
}

TEST(CertifyConvergenceTest, WhatIsLeftAtRestBelowTheToleranceDoesNotMatter) {
  const Certificate usual = CertifyPress({});
  EXPECT_TRUE(usual.certified);
  EXPECT_LT(usual.full.unresolved, 1e-4);
  StepConfig config;
  config.tolerance_many = 0.0;  // no step ever converges
  const Certificate result = CertifyPress(config);
  EXPECT_TRUE(result.certified);
  EXPECT_NEAR(result.full.not_converged * config.dt, result.full.seconds, 1e-9);
  EXPECT_LT(result.full.unresolved, 1e-4);
}

// A box that a finger presses from the side, `z` above the table, and does not move.
Certificate PressFromTheSide(double z) {
  Scene scene = MakeRulerScene();
  Body& box = scene.object();
  box.shape = Box{{0.10, 0.10, 0.04}};
  box.X_WB.translation() = Vector3(-0.3, 0.0, 0.02);
  box.mass_properties = CalcMassProperties(box.shape, 0.3);
  StepConfig half;
  half.dt /= 2;
  const World world(scene), half_world(scene, half);
  WorldPlan plan;
  plan.stages.resize(1);
  WorldPlan::Finger& index = plan.stages[0][1];
  index.on = true;
  index.contact = {true, Vector3(-0.05, 0.0, z - 0.02), -Vector3::UnitX()};
  index.p_WTargets.assign(4, Vector3(-0.35 + 0.01, 0.0, z));
  return CertifyPlan(world, half_world, EnvironmentDistance(scene), world.InitialState(), plan,
                     PlanTiming(), CertifyConfig());
}

TEST(CertifyTipTest, AFingertipMayBe3TenthsOfAMillimetreInTheSurroundingsAndNoMore) {
  EXPECT_TRUE(PressFromTheSide(0.0090 - 0.00025).certified);
  const Certificate deeper = PressFromTheSide(0.0090 - 0.00035);
  EXPECT_FALSE(deeper.certified);
  EXPECT_EQ(deeper.reasons, std::vector<CertifyReason>{CertifyReason::kTipOverlap});
  EXPECT_NEAR(deeper.full.max_tip_overlap, 0.00035, 2e-5);
}

TEST_F(CertifyTest, FingertipsThatOverlapEachOtherAreNotCertified) {
  // Thumb and index finger press the top: their spheres need 19.9 mm between their centres, which
  // are 1.9 mm apart in height.
  for (const double apart : {0.0197, 0.0199}) {
    WorldPlan plan = MakeRulerDrag(0.01, 0.0);
    WorldPlan::Finger& thumb = plan.stages[0][0];
    thumb.on = true;
    thumb.contact = {true, Vector3(apart, 0.0, 0.0015), Vector3::UnitZ()};
    thumb.p_WTargets.assign(4, Vector3(-0.16 + apart, 0.0, 0.003 - 0.01));
    const Certificate result = Certify(plan);
    EXPECT_NEAR(result.full.min_tip_gap, std::hypot(apart, 0.0019) - 0.0199, 1e-5);
    const bool too_close = std::find(result.reasons.begin(), result.reasons.end(),
                                     CertifyReason::kTipsTooClose) != result.reasons.end();
    EXPECT_EQ(too_close, apart < 0.0198) << apart;
  }
}

}  // namespace
}  // namespace pregrasp
