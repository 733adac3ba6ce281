#include "app/trajectory/simulate_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/trajectory/ruler_fixture.h"

namespace pregrasp {
namespace {

constexpr int kThumb = 0, kIndex = 1;

WorldPlan::Finger PressTop(double x) {
  WorldPlan::Finger finger;
  finger.on = true;
  finger.contact = {true, Vector3(x, 0.0, 0.0015), Vector3::UnitZ()};
  finger.p_WTargets.assign(4, Vector3(-0.16 + x, 0.0, 0.003 - 0.01));
  return finger;
}

WorldPlan::Finger Keep(WorldPlan::Finger finger) {
  finger.kept = true;
  return finger;
}

class SimulatePlanTest : public ::testing::Test {
 protected:
  PlanOutcome Simulate(const WorldPlan& plan, Stepper stepper = Stepper::kKernel) {
    trace_.clear();
    return SimulatePlan(ruler_.world, ruler_.environment, ruler_.world.InitialState(), plan,
                        timing_, stepper, &trace_);
  }

  // Seconds during which a finger is on, or `on` is false, off.
  double CountSeconds(int finger, bool on) const {
    double seconds = 0.0;
    for (std::size_t i = 1; i < trace_.size(); ++i) {
      if (trace_[i].state.fingers[finger].on == on) seconds += ruler_.world.config().dt;
    }
    return seconds;
  }

  const RulerProblem ruler_;
  PlanTiming timing_;
  std::vector<TraceRow> trace_;
};

TEST_F(SimulatePlanTest, BeforeAFingerMovesToANewContactTheHandHasTheTimeToGetThere) {
  WorldPlan plan;
  plan.stages.resize(2);
  plan.stages[0][kIndex] = PressTop(0.02);
  plan.stages[1][kIndex] = PressTop(-0.07);
  for (const Stepper stepper : {Stepper::kKernel, Stepper::kSimbody}) {
    const PlanOutcome outcome = Simulate(plan, stepper);
    ASSERT_EQ(outcome.waits.size(), 2U);
    EXPECT_EQ(outcome.waits[0], 0.0);
    EXPECT_NEAR(outcome.waits[1], 0.3 + 0.09 / 0.15, 1e-3);
    EXPECT_NEAR(outcome.seconds, 2 * 0.8 + outcome.waits[1] + 1.5, 0.01);
    EXPECT_NEAR(CountSeconds(kIndex, false), outcome.waits[1], 0.01);
    EXPECT_NEAR(outcome.stage_starts[1].t, 0.8 + outcome.waits[1], 0.01);
  }
}

TEST_F(SimulatePlanTest, AFingerThatIsKeptHoldsItsTargetWhileTheOtherComesFromWhereItIs) {
  WorldPlan plan;
  plan.stages.resize(2);
  plan.stages[0][kIndex] = PressTop(0.0);
  plan.stages[1][kIndex] = Keep(PressTop(0.0));
  plan.stages[1][kThumb] = PressTop(-0.03);
  timing_.transfer_speed = 0.05;
  const PlanOutcome outcome = Simulate(plan);
  EXPECT_NEAR(outcome.waits[1], 0.3 + 0.03 / 0.05, 1e-3);
  EXPECT_EQ(CountSeconds(kIndex, false), 0.0);
  EXPECT_NEAR(CountSeconds(kThumb, true), 0.8 + 1.5, 0.01);
  for (const TraceRow& row : trace_) {
    if (row.state.t < 0.8) continue;
    EXPECT_NEAR(row.state.fingers[kIndex].p_WTarget.z(), -0.007, 1e-12) << row.state.t;
  }
}

TEST_F(SimulatePlanTest, AFingerComesFromWhereItWasOnLastHoweverLongAgo) {
  WorldPlan plan;
  plan.stages.resize(3);
  plan.stages[0][kThumb] = PressTop(0.10);
  plan.stages[1][kIndex] = PressTop(0.0);
  plan.stages[2][kIndex] = Keep(PressTop(0.0));
  plan.stages[2][kThumb] = PressTop(-0.05);
  const PlanOutcome outcome = Simulate(plan);
  EXPECT_NEAR(outcome.waits[1], 0.3 + 0.10 / 0.15, 1e-3);  // the index finger, from the thumb
  EXPECT_NEAR(outcome.waits[2], 0.3 + 0.15 / 0.15, 1e-3);
}

TEST_F(SimulatePlanTest, NothingIsWaitedForWhereFingersOnlyStayOrLeave) {
  WorldPlan plan;
  plan.stages.resize(2);
  plan.stages[0][kThumb] = PressTop(0.05);
  plan.stages[0][kIndex] = PressTop(0.0);
  plan.stages[1][kIndex] = Keep(PressTop(0.0));
  const PlanOutcome outcome = Simulate(plan);
  EXPECT_EQ(outcome.waits, (std::vector<double>{0.0, 0.0}));
  EXPECT_NEAR(outcome.seconds, 2 * 0.8 + 1.5, 0.01);
}

TEST_F(SimulatePlanTest, ATipThatTouchesIsAsFastAsItsContactAndOneInTheAirDoesNotCount) {
  // The ruler is dragged firmly by 8 cm in 0.8 s: it sticks to the finger, whose target goes at
  // 0.1 m/s from the first step on.
  const PlanOutcome drag = Simulate(MakeRulerDrag(0.02, 0.08));
  double fastest = 0.0;
  for (const TraceRow& row : trace_) {
    fastest = std::max(fastest, row.state.bodies[0].v_WB.norm());
  }
  EXPECT_NEAR(drag.max_tip_speed, fastest, 0.2 * fastest);
  EXPECT_GT(drag.max_tip_acceleration, 0.1 / 0.1);
  EXPECT_LT(drag.max_tip_acceleration, 8.0);
  WorldPlan flight = MakeRulerDrag(-0.05, 2.0);  // 5 cm above it, at 2.5 m/s
  const PlanOutcome air = Simulate(flight);
  EXPECT_LT(air.max_tip_speed, 0.1);
}

TEST_F(SimulatePlanTest, TheFirstRowHasWhatCarriesTheRestingRuler) {
  const WorldPlan drag = MakeRulerDrag(0.02, 0.08);
  for (const Stepper stepper : {Stepper::kKernel, Stepper::kSimbody}) {
    Simulate(drag, stepper);
    const TraceRow& start = trace_.front();
    EXPECT_EQ(start.state.t, 0.0);
    EXPECT_EQ(start.state.bodies[0].p_WB, ruler_.world.InitialState().bodies[0].p_WB);
    Vector3 f_W = Vector3::Zero();  // on the ruler, which is the first of each pair
    for (const ContactPoint& contact : start.contacts) f_W -= contact.f_W;
    const double weight = 0.025 * 9.81;
    EXPECT_NEAR(f_W.z(), weight, 1e-6 * weight);
    EXPECT_LT(f_W.head<2>().norm(), 1e-6 * weight);
  }
}

TEST_F(SimulatePlanTest, ATraceChangesNothingOfARelativePlan) {
  RelativePlan plan;
  plan.stages.resize(1);
  plan.stages[0][kIndex].on = true;
  plan.stages[0][kIndex].contact.p_OC = Vector3(0.05, 0.0, 0.0015);
  plan.stages[0][kIndex].knots.resize(timing_.knots);
  for (auto& knot : plan.stages[0][kIndex].knots) {
    knot.depth = 0.01;
    knot.travel_W = Vector3(0.01, 0.0, 0.0);
  }
  const WorldState start = ruler_.world.InitialState();
  const PlanOutcome alone = SimulatePlan(ruler_.world, ruler_.environment, start, plan, timing_);
  const PlanOutcome traced =
      SimulatePlan(ruler_.world, ruler_.environment, start, plan, timing_, &trace_);
  EXPECT_GT((alone.end.bodies[0].p_WB - start.bodies[0].p_WB).norm(), 0.01);
  EXPECT_EQ(alone.end.bodies[0].p_WB, traced.end.bodies[0].p_WB);
  EXPECT_EQ(alone.end.bodies[0].q_WB.coeffs(), traced.end.bodies[0].q_WB.coeffs());
  EXPECT_EQ(trace_.back().state.bodies[0].p_WB, traced.end.bodies[0].p_WB);
  EXPECT_FALSE(trace_.back().contacts.empty());
}

}  // namespace
}  // namespace pregrasp
