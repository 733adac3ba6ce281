#include "app/trajectory/cost.h"

#include <gtest/gtest.h>

#include "tests/trajectory/ruler_fixture.h"

namespace pregrasp {
namespace {

// A plan that does nothing wrong, to spoil.
class PlanCostTest : public testing::Test {
 protected:
  PlanCostTest() {
    outcome_ = SimulatePlan(ruler_.world, ruler_.environment, ruler_.world.InitialState(),
                            MakeRulerDrag(0.01, 0.0), PlanTiming(), Stepper::kKernel);
    scores_.assign(outcome_.stage_starts.size(), 0.1);
  }
  PlanCost Calc(double final_score = 0.5, double room = 0.0, double scale = 0.02) const {
    return CalcPlanCost(ruler_.world, outcome_, scores_, final_score, room, CostWeights(), 0.7,
                        scale);
  }

  const RulerProblem ruler_;
  PlanOutcome outcome_;
  std::vector<double> scores_;
};

TEST(CalcRewardTest, AStagesStartCountsAtMostAsMuchAsTheEnd) {
  const std::vector<double> low{0.1, 0.2}, high{0.1, 0.9};
  EXPECT_NEAR(CalcReward(low, 0.5), 0.8, 1e-15);
  EXPECT_NEAR(CalcReward(high, 0.0), 0.0, 1e-15);
  EXPECT_GT(CalcReward(low, 0.5), CalcReward(high, 0.3));
  for (const double end : {0.0, 0.2, 0.5, 0.9}) {  // strictly rising in the end
    EXPECT_GE(CalcReward(high, end + 0.1) - CalcReward(high, end), 0.1 - 1e-15);
  }
}

TEST(CalcScoreScaleTest, IsTheStandardDeviationAndNeverNothing) {
  const std::vector<double> apart{1.0, 2.0, 3.0, 4.0}, alike{0.3, 0.3};
  EXPECT_NEAR(CalcScoreScale(apart), std::sqrt(1.25), 1e-15);
  EXPECT_EQ(CalcScoreScale(alike), kLeastScoreScale);
}

TEST_F(PlanCostTest, TieBreakersGoByTheScaleAndWhatACertificateRefusesDoesNot) {
  outcome_.slip_seconds = outcome_.contact_seconds;
  outcome_.max_tip_overlap = 0.0045;
  const PlanCost fine = Calc(0.5, 0.0, 0.01), coarse = Calc(0.5, 0.0, 0.1);
  EXPECT_NEAR(coarse.slip, 10.0 * fine.slip, 1e-15);
  EXPECT_NEAR(coarse.effort, 10.0 * fine.effort, 1e-15);
  EXPECT_NEAR(fine.slip, 0.01 * CostWeights().slip, 1e-15);
  EXPECT_EQ(coarse.tip_overlap, fine.tip_overlap);
  EXPECT_NEAR(fine.tip_overlap, 0.5 * CostWeights().tip_overlap, 1e-12);
}

TEST_F(PlanCostTest, TheTotalIsMinusTheRewardPlusAllTerms) {
  outcome_.slip_seconds = 0.5 * outcome_.contact_seconds;
  outcome_.min_tip_gap = -0.003;
  const PlanCost cost = Calc(0.4, 0.2);
  double total = -cost.reward, value = cost.reward;
  for (const CostTerm& term : CostTerms()) {
    total += cost.*term.value;
    if (!term.tie_breaker) value -= cost.*term.value;
  }
  EXPECT_NEAR(cost.total, total, 1e-15);
  EXPECT_NEAR(cost.CalcValue(), value, 1e-15);
  EXPECT_NEAR(cost.reward, CalcReward(scores_, 0.4 + CostWeights().room * 0.2), 1e-15);
}

TEST_F(PlanCostTest, MovingInTheHoldCostsFromHalfOfWhatACertificateAllowsOn) {
  const Vector3 held = outcome_.hold_start.bodies[0].p_WB;
  const auto cost_at = [&](double shift) {
    outcome_.end = outcome_.hold_start;
    outcome_.end.bodies[0].p_WB = held + Vector3(shift, 0, 0);
    return Calc().hold;
  };
  EXPECT_EQ(cost_at(0.0), 0.0);
  EXPECT_EQ(cost_at(0.0049), 0.0);
  EXPECT_NEAR(cost_at(0.010), 0.5 * CostWeights().hold, 1e-9);
  EXPECT_NEAR(cost_at(0.015), 1.0 * CostWeights().hold, 1e-9);
  EXPECT_NEAR(cost_at(1.0), 2.0 * CostWeights().hold, 1e-12);
}

TEST_F(PlanCostTest, ATipThatIsTooFastOrTooAbruptForAHandCostsByTheWorseOfBoth) {
  const auto cost_at = [&](double speed, double acceleration) {
    outcome_.max_tip_speed = speed;
    outcome_.max_tip_acceleration = acceleration;
    return Calc().haste;
  };
  EXPECT_EQ(cost_at(0.79, 7.9), 0.0);
  EXPECT_NEAR(cost_at(1.2, 7.9), 0.5 * CostWeights().haste, 1e-12);
  EXPECT_NEAR(cost_at(1.2, 14.0), 0.75 * CostWeights().haste, 1e-12);
  EXPECT_NEAR(cost_at(0.1, 90.0), CostWeights().haste, 1e-12);
}

TEST(CalcFragilityTest, IsTheMeanOfHowFarAwayOtherWorldsEnd) {
  PlanOutcome here;
  here.end.bodies.resize(1);
  const auto at = [&](double x, double degrees) {
    PlanOutcome outcome = here;
    outcome.end.bodies[0].p_WB.x() += x;
    outcome.end.bodies[0].q_WB = Quaternion(Eigen::AngleAxisd(DegToRad(degrees), Vector3::UnitZ()));
    return outcome;
  };
  const auto fragility = [&](const std::vector<PlanOutcome>& others) {
    return CalcFragility(here, others);
  };
  EXPECT_EQ(fragility({}), 0.0);
  EXPECT_NEAR(fragility({at(0, 0), at(0, 0)}), 0.0, 1e-12);
  EXPECT_NEAR(fragility({at(0.02, 0)}), 0.5, 1e-12);
  EXPECT_NEAR(fragility({at(0, 10)}), 0.5, 1e-9);
  EXPECT_NEAR(fragility({at(0.01, 20)}), 1.0, 1e-9);  // the worse of both
  EXPECT_NEAR(fragility({at(0, 0), at(5, 0)}), 0.5, 1e-12);
  PlanOutcome diverged = here;  // near, as what is kept is the last finite state
  diverged.diverged = true;
  EXPECT_EQ(fragility({diverged}), 1.0);
  EXPECT_EQ(CalcFragility(diverged, {}), 1.0);
}

TEST_F(PlanCostTest, AFragilePlanLosesOfWhatItGainsAndNoMore) {
  const double weight = CostWeights().fragility;
  const auto add = [&](double fragility, double rest_reward) {
    PlanCost cost = Calc(0.4);
    const double before = cost.total;
    AddFragility(cost, fragility, CostWeights(), rest_reward);
    EXPECT_NEAR(cost.total, before + cost.fragility, 1e-15);
    return cost;
  };
  const double reward = Calc(0.4).reward;
  EXPECT_EQ(add(0.0, 0.1).fragility, 0.0);
  EXPECT_NEAR(add(0.5, reward - 0.2).fragility, 0.5 * weight * 0.2, 1e-15);
  EXPECT_NEAR(add(1.0, reward - 0.2).fragility, weight * 0.2, 1e-15);
  EXPECT_EQ(add(1.0, reward + 0.2).fragility, 0.0);  // worse than doing nothing as it is
}

TEST_F(PlanCostTest, OverlapOfATipCostsByItsDepthWithoutAJump) {
  const auto cost_at = [&](double overlap) {
    outcome_.max_tip_overlap = overlap;
    return Calc().tip_overlap;
  };
  EXPECT_EQ(cost_at(-0.01), 0.0);
  EXPECT_NEAR(cost_at(0.0001), CostWeights().tip_overlap / 90.0, 1e-12);
  EXPECT_NEAR(cost_at(0.0045), CostWeights().tip_overlap / 2.0, 1e-12);
  EXPECT_EQ(cost_at(0.5), CostWeights().tip_overlap);
}

}  // namespace
}  // namespace pregrasp
