#include "app/grasp/lift.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/grasp/grasp_scenes.h"

namespace pregrasp {
namespace {

// An upright carton that a hand can close on.
Scene CartonOnTable(double mass) {
  Scene scene = MakeScene("carton", Box{{0.05, 0.06, 0.12}}, mass, Shift(0, 0, 0.06));
  scene.bodies.push_back(FixedBox("table", {0.8, 0.8, 0.02}, {0, 0, -0.01}));
  return scene;
}

StepConfig HalfStep() {
  StepConfig config;
  config.dt *= 0.5;
  return config;
}

// A scene with all that a lift needs.
struct LiftProblem {
  explicit LiftProblem(const Scene& scene_in)
      : scene(scene_in),
        world(scene),
        half_world(scene, HalfStep()),
        grasp_world(scene, ShadowHand()) {
    up.status = LiftWayStatus::kFree;
    up.length = 0.10;
  }

  // Thumb against index and middle across y, `z` above the object's middle.
  GraspResult Pinch(double half_width, double z) const {
    const std::vector<GraspContact> contacts = {
        {Finger::kThumb, Vector3(0.0, -half_width, z), -Vector3::UnitY()},
        {Finger::kIndex, Vector3(0.011, half_width, z), Vector3::UnitY()},
        {Finger::kMiddle, Vector3(-0.011, half_width, z), Vector3::UnitY()}};
    return TestContacts(grasp_world, GraspConfig(), contacts, grasp_world.StartPoses(),
                        Rng(1, RngStream::kTest));
  }

  LiftResult Lift(const GraspResult& grasp) const { return Lift(grasp, world.InitialState()); }
  LiftResult Lift(const GraspResult& grasp, const WorldState& state) const {
    return LiftGrasp({world, half_world, grasp_world}, state, grasp, up, LiftConfig());
  }

  Scene scene;
  World world, half_world;
  GraspWorld grasp_world;
  LiftWay up;
};

bool Has(const LiftResult& lift, LiftReason reason) {
  return std::find(lift.reasons.begin(), lift.reasons.end(), reason) != lift.reasons.end();
}

TEST(LiftTest, ACartonFollowsTheHandAndWithstandsPushesInAllDirections) {
  const LiftProblem problem(CartonOnTable(0.2));
  const GraspResult grasp = problem.Pinch(0.03, 0.0);
  ASSERT_TRUE(grasp.feasible());
  const LiftResult lift = problem.Lift(grasp);
  EXPECT_TRUE(lift.held) << Explain(lift, problem.scene);
  EXPECT_TRUE(lift.reasons.empty());
  EXPECT_NEAR(lift.height, 0.10, 0.002);
  EXPECT_LT(lift.shift, 0.01);
  EXPECT_FALSE(lift.touching_body.has_value());
  EXPECT_EQ(lift.pushes, kNumPushes);
  EXPECT_TRUE(lift.soft);
  EXPECT_TRUE(lift.stiff);
}

TEST(LiftTest, TheTraceHasEveryStepFromTheCertifiedEndOn) {
  const LiftProblem problem(CartonOnTable(0.2));
  const LiftResult lift = problem.Lift(problem.Pinch(0.03, 0.03));
  const LiftConfig config;
  const double seconds =
      config.handover_seconds + config.closing_seconds + config.lift_seconds + config.hold_seconds;
  EXPECT_EQ(lift.trace.size(), static_cast<std::size_t>(std::lround(240.0 * seconds)) + 1);
  EXPECT_EQ(lift.trace.front().state.t, 0.0);
  EXPECT_NEAR(lift.closing_t, 0.1, 1e-9);
  EXPECT_NEAR(lift.lift_t, 0.7, 1e-9);
  EXPECT_NEAR(lift.hold_t, 1.9, 1e-9);
  EXPECT_EQ(lift.trace.back().state.bodies.front().p_WB, lift.end.bodies.front().p_WB);
  for (const TraceRow& row : lift.trace) {
    const auto& fingers = row.state.fingers;
    for (const int f : {0, 1, 2}) {
      EXPECT_EQ(fingers[f].on, row.state.t > lift.closing_t + 1e-9);
      EXPECT_EQ(fingers[f].stiffness, fingers[f].on ? 300.0 : 0.0);
    }
    EXPECT_FALSE(fingers[3].on || fingers[4].on);
  }
}

TEST(LiftTest, WhenTheGraspHasClosedTheFingersAloneCarryTheObject) {
  const LiftProblem problem(CartonOnTable(0.2));
  const LiftResult lift = problem.Lift(problem.Pinch(0.03, 0.03));
  for (const TraceRow& row : lift.trace) {
    if (std::abs(row.state.t - lift.lift_t) > 1e-6) continue;
    Vector3 from_fingers = Vector3::Zero();
    for (const FingertipState& tip : row.state.fingers) from_fingers += tip.f_W;
    EXPECT_NEAR(from_fingers.z(), 0.2 * 9.81, 0.1);
    for (int i = 0; i < 3; ++i) {
      const Vector3 f_O = lift.grip.forces_O.row(i);
      EXPECT_LT((row.state.fingers[i].f_W - f_O).norm(), 0.1);
    }
    return;
  }
  FAIL() << "no row where the lift begins";
}

TEST(LiftTest, APressingFingerKeepsItsForceAtTheSwitchAndOneThatLeavesLetsGo) {
  const LiftProblem problem(CartonOnTable(0.2));
  const GraspResult grasp = problem.Pinch(0.03, 0.03);
  WorldState state = problem.world.InitialState();
  const auto press = [&](Finger finger, const Vector3& p_OC, const Vector3& offset) {
    problem.world.PutFinger(state, finger, p_OC);
    state.fingers[static_cast<int>(finger)].p_WTarget += offset;
  };
  // The thumb where the grasp has it; the index on the top, from where it has to move.
  press(Finger::kThumb, Vector3(0.0, -0.03, 0.03), Vector3(0.0, 0.01, 0.0));
  press(Finger::kIndex, Vector3(0.0, 0.0, 0.06), Vector3(0.0, 0.0, -0.02));
  for (int i = 0; i < 240; ++i) problem.world.Step(state);
  const LiftResult lift = problem.Lift(grasp, state);
  EXPECT_TRUE(lift.held) << Explain(lift, problem.scene);
  EXPECT_NEAR(state.fingers[0].f_W.norm(), 0.5, 1e-3);
  for (const TraceRow& row : lift.trace) {
    if (row.state.t > lift.closing_t + 1e-9) break;
    EXPECT_LT((row.state.fingers[0].f_W - state.fingers[0].f_W).norm(), 0.01);
    EXPECT_EQ(row.state.fingers[0].p_OC, state.fingers[0].p_OC);
  }
  // The index on the top pressed with a newton, less and less, and is off before the grasp closes.
  const WorldState& closing =
      std::find_if(lift.trace.begin(), lift.trace.end(), [&](const auto& row) {
        return row.state.t > lift.closing_t + 1e-9;
      })->state;
  EXPECT_NEAR(closing.fingers[1].p_OC.y(), 0.03, 1e-9);
  EXPECT_LT(closing.fingers[1].f_W.norm(), 0.1);
}

TEST(LiftTest, WithSlipperyFingersItStaysBehind) {
  const LiftProblem problem(CartonOnTable(0.06));
  const GraspResult grasp = problem.Pinch(0.03, 0.03);
  Scene slippery = problem.scene;
  slippery.fingertips.friction = 0.02;
  const World world(slippery), half_world(slippery, HalfStep());
  const LiftResult lift = LiftGrasp({world, half_world, problem.grasp_world}, world.InitialState(),
                                    grasp, problem.up, LiftConfig());
  EXPECT_FALSE(lift.held);
  EXPECT_TRUE(Has(lift, LiftReason::kDoesNotFollow));
  EXPECT_TRUE(Has(lift, LiftReason::kStillTouches));
  EXPECT_EQ(lift.touching_body, BodyIndex{1});
  EXPECT_EQ(lift.pushes, 0);
}

TEST(LiftTest, AFingertipThatEntersTheTableFailsItByName) {
  const LiftProblem problem(CartonOnTable(0.02));
  // A contact 8 mm above the table: the thumb's sphere has a radius of 10.9 mm.
  GraspResult grasp = problem.Pinch(0.03, 0.0);
  ASSERT_TRUE(grasp.feasible());
  for (GraspContact& contact : grasp.contacts) contact.p_OC.z() = -0.052;
  grasp.contacts[1].p_OC.x() = 0.022;  // so low, a wider grasp is needed to be stiff
  grasp.contacts[2].p_OC.x() = -0.022;
  const LiftResult lift = problem.Lift(grasp);
  EXPECT_FALSE(lift.held);
  EXPECT_EQ(lift.reasons.front(), LiftReason::kTipOverlap);
  EXPECT_EQ(lift.deepest_tip, Finger::kThumb);
  EXPECT_NEAR(lift.tip_overlap, 0.0029, 2e-4);
}

TEST(LiftTest, SoftFingersGiveWayAndAreNotSimulated) {
  Scene scene = CartonOnTable(1.0);
  scene.fingertips.grasp_stiffness = 30.0;
  const LiftProblem problem(scene);
  const GraspResult grasp = problem.Pinch(0.03, 0.03);
  ASSERT_TRUE(grasp.feasible());
  const LiftResult lift = problem.Lift(grasp);
  EXPECT_EQ(lift.reasons, std::vector<LiftReason>{LiftReason::kGivesWay});
  EXPECT_FALSE(lift.simulated);
  EXPECT_TRUE(lift.trace.empty());
  EXPECT_NE(Explain(lift, scene).find("gives way"), std::string::npos);
}

TEST(LiftTest, WithoutAFreeWayThatIsTheReason) {
  LiftProblem problem(CartonOnTable(0.2));
  const GraspResult grasp = problem.Pinch(0.03, 0.03);
  problem.up.status = LiftWayStatus::kNoFreeDirection;
  EXPECT_EQ(problem.Lift(grasp).reasons, std::vector<LiftReason>{LiftReason::kNoFreeDirection});
  problem.up.status = LiftWayStatus::kNeverFree;
  EXPECT_EQ(problem.Lift(grasp).reasons, std::vector<LiftReason>{LiftReason::kNeverFree});
}

TEST(LiftTest, WhatLiesOnTheObjectStillTouchesItAtTheEnd) {
  Scene scene = CartonOnTable(0.2);
  Body plate = FixedBox("plate", {0.04, 0.04, 0.004}, {0, 0, 0.122});
  plate.mass_properties = CalcMassProperties(plate.shape, 0.01);
  scene.bodies.push_back(plate);
  const LiftProblem problem(scene);
  const LiftResult lift = problem.Lift(problem.Pinch(0.03, 0.03));
  EXPECT_EQ(lift.reasons, std::vector<LiftReason>{LiftReason::kStillTouches});
  EXPECT_EQ(lift.touching_body, BodyIndex{2});
  EXPECT_NEAR(lift.neighbour_moved, 0.10, 0.01);
  EXPECT_FALSE(lift.neighbours.disturbed);  // it came up with the carton
}

TEST(LiftTest, WhatTheContactSolverLeavesUnfinishedIsToldAndFromAMillimetreOnNotHeld) {
  // A crate of 40 kg stands on a strip of 1 g beside the carton: what carries it is not found.
  Scene scene = CartonOnTable(0.2);
  Body crate = FixedBox("crate", {0.3, 0.3, 0.2}, {0.25, 0.25, 0.104});
  Body strip = FixedBox("strip", {0.3, 0.008, 0.004}, {0.25, 0.25, 0.002});
  crate.mass_properties = CalcMassProperties(crate.shape, 40.0);
  strip.mass_properties = CalcMassProperties(strip.shape, 0.001);
  scene.bodies.push_back(crate);
  scene.bodies.push_back(strip);
  const LiftProblem problem(scene);
  const LiftResult lift = problem.Lift(problem.Pinch(0.03, 0.03));
  EXPECT_GT(lift.not_converged, 0);
  EXPECT_GT(lift.unresolved, 1e-3);
  EXPECT_EQ(lift.reasons, std::vector<LiftReason>{LiftReason::kNotConverged});
  EXPECT_NE(Explain(lift, scene).find("may have sunk"), std::string::npos);
  // Alone, the carton's lift leaves nothing of that size.
  EXPECT_LT(LiftProblem(CartonOnTable(0.2)).Lift(problem.Pinch(0.03, 0.03)).unresolved, 1e-4);
}

TEST(LiftTest, AWayAsideAndThenUpIsFollowedToItsEnd) {
  LiftProblem problem(CartonOnTable(0.2));
  problem.up.direction_W = Vector3(0.6, 0.0, 0.8);
  problem.up.length = 0.15;
  problem.up.rise_W = Vector3(0.0, 0.0, 0.02);
  const LiftResult lift = problem.Lift(problem.Pinch(0.03, 0.03));
  EXPECT_TRUE(lift.held) << Explain(lift, problem.scene);
  const Vector3 way = lift.end.bodies.front().p_WB - Vector3(0, 0, 0.06);
  EXPECT_LT((way - Vector3(0.09, 0.0, 0.14)).norm(), 0.003);
}

TEST(LiftTest, APushBeyondWhatTheFingersHoldMovesTheObject) {
  const LiftProblem problem(CartonOnTable(0.2));
  const LiftResult lift = problem.Lift(problem.Pinch(0.03, 0.0));
  ASSERT_TRUE(lift.held);
  const auto pushed = [&](double force) {
    return SimulatePush(problem.world, problem.grasp_world.environment(), lift.end,
                        Vector3(force, 0, 0));
  };
  EXPECT_TRUE(WithstandsPush(pushed(0.3)));
  EXPECT_FALSE(WithstandsPush(pushed(20.0)));
  // Three springs give by force / (3 k), and by up to twice that as the push begins.
  EXPECT_GT(pushed(0.3).shift, 0.9 * 0.3 / 900.0);
  EXPECT_LT(pushed(0.3).shift, 2.0 * 0.3 / 900.0 + 1e-4);
}

TEST(LiftTest, OfTwoLiftsTheOneThatHoldsThenWithstandsMoreIsPreferred) {
  LiftResult dropped, weak, firm;
  weak.held = firm.held = true;
  weak.pushes = 5;
  weak.soft = weak.stiff = true;
  firm.pushes = 6;
  EXPECT_TRUE(WithstandsMore(weak, dropped));
  EXPECT_TRUE(WithstandsMore(firm, weak));
  EXPECT_FALSE(WithstandsMore(weak, firm));
  EXPECT_FALSE(WithstandsMore(firm, firm));
  LiftResult firmer = firm;
  firmer.stiff = true;
  EXPECT_TRUE(WithstandsMore(firmer, firm));
  firmer.neighbours.disturbed = true;
  EXPECT_TRUE(WithstandsMore(weak, firmer));
  EXPECT_TRUE(WithstandsMore(firmer, dropped));
}

TEST(LiftTest, ALiftThatIsNotANumberDoesNotHold) {
  LiftOutcome outcome;
  EXPECT_TRUE(JudgeLift(outcome).empty());
  outcome.shift = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(JudgeLift(outcome).empty());
  outcome = {};
  outcome.tip_overlap = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(JudgeLift(outcome).empty());
  outcome = {};
  outcome.unresolved = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(JudgeLift(outcome), std::vector<LiftReason>{LiftReason::kNotConverged});
  outcome = {};
  EXPECT_TRUE(WithstandsPush(outcome));
  outcome.end_turn_deg = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(WithstandsPush(outcome));
}

}  // namespace
}  // namespace pregrasp
