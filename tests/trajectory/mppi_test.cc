#include "app/trajectory/mppi.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "app/core/error.h"
#include "app/trajectory/robust.h"
#include "tests/trajectory/ruler_fixture.h"

namespace pregrasp {
namespace {

MppiConfig QuickConfig() {
  MppiConfig config;
  config.samples = 24;
  config.iterations = 6;
  return config;
}

MppiState RunIterations(const Mppi& mppi, int iterations, int threads) {
  ThreadPool pool(threads);
  MppiState state = mppi.Start();
  for (int i = 0; i < iterations; ++i) mppi.Step(state, pool);
  return state;
}

void ExpectSameBits(const MppiState& a, const MppiState& b) {
  EXPECT_EQ(a.mean, b.mean);
  EXPECT_EQ(a.best_action, b.best_action);
  EXPECT_EQ(a.best_history, b.best_history);
  EXPECT_EQ(a.mean_history, b.mean_history);
}

TEST(MppiTest, DragsTheRulerOverTheEdge) {
  const RulerProblem ruler;
  int solved = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Mppi mppi(ruler.Make(2, seed), MppiConfig());
    ThreadPool pool(2);
    MppiState state = mppi.Start();
    while (!state.ended()) mppi.Step(state, pool);
    const PlanOutcome outcome = mppi.Simulate(state.best_action);
    const double overhang = (outcome.end.bodies[0].X_WB() * Vector3(0.15, 0, 0)).x();
    solved += overhang > 0.06;
    EXPECT_LE(outcome.max_force, ruler.scene.fingertips.max_force * (1 + 1e-9));
  }
  EXPECT_GE(solved, 2);
}

TEST(MppiTest, OneAndTwoThreadsGiveTheSameBits) {
  const RulerProblem ruler;
  const Mppi mppi(ruler.Make(1, 7), QuickConfig());
  ExpectSameBits(RunIterations(mppi, 3, 1), RunIterations(mppi, 3, 2));
}

// A run's seed in the low half of a word and a path's rank in the high half would make these two
// the same search.
TEST(MppiTest, NoPathOfASeedDrawsThePlansOfAnotherSeedsPath) {
  const RulerProblem ruler;
  MppiProblem second = ruler.Make(1, 1), first = ruler.Make(1, 1 + (1ULL << 32));
  second.path.rank = 2;
  first.path.rank = 1;
  MppiProblem other_seed = first;
  other_seed.seed = 1;
  const auto mean = [](const MppiProblem& problem) {
    return RunIterations(Mppi(problem, QuickConfig()), 1, 1).mean;
  };
  EXPECT_EQ(mean(second), mean(second));
  EXPECT_NE(mean(second), mean(first));
  EXPECT_NE(mean(first), mean(other_seed));
  EXPECT_NE(mean(second), mean(other_seed));
}

TEST(MppiTest, GoingBackAndOnAgainGivesTheSameBits) {
  const RulerProblem ruler;
  const Mppi mppi(ruler.Make(1, 7), QuickConfig());
  ThreadPool pool(1);
  MppiState state = RunIterations(mppi, 1, 1);
  const MppiState earlier = state;
  mppi.Step(state, pool);
  mppi.Step(state, pool);
  MppiState again = earlier;
  mppi.Step(again, pool);
  mppi.Step(again, pool);
  ExpectSameBits(state, again);
}

TEST(MppiTest, AForkWithAnotherSigmaDiffers) {
  const RulerProblem ruler;
  MppiConfig wide = QuickConfig();
  wide.sigma = 1.5;
  const Mppi mppi(ruler.Make(1, 7), QuickConfig()), fork(ruler.Make(1, 7), wide);
  ThreadPool pool(1);
  MppiState a = RunIterations(mppi, 2, 1);
  MppiState b = a;
  mppi.Step(a, pool);
  fork.Step(b, pool);
  EXPECT_NE(a.mean, b.mean);
}

TEST(MppiTest, TheBestCostNeverRisesAndWeightsSumToOne) {
  const RulerProblem ruler;
  const Mppi mppi(ruler.Make(3, 2), QuickConfig());
  const MppiState state = RunIterations(mppi, 5, 2);
  for (std::size_t i = 1; i < state.best_history.size(); ++i) {
    EXPECT_LE(state.best_history[i], state.best_history[i - 1]);
  }
  double sum = 0.0;
  for (const MppiSample& sample : state.samples) sum += sample.weight;
  EXPECT_NEAR(sum, 1.0, 1e-12);
}

TEST(MppiTest, ItSaysWhetherPatienceOrTheLimitOfIterationsEndedIt) {
  const RulerProblem ruler;
  MppiConfig config = QuickConfig();
  config.iterations = 3;
  config.rise = 0.0;
  MppiState state = RunIterations(Mppi(ruler.Make(1, 1), config), 2, 1);
  EXPECT_FALSE(state.ended());
  state = RunIterations(Mppi(ruler.Make(1, 1), config), 3, 1);
  EXPECT_EQ(state.end, MppiEnd::kLimit);
  EXPECT_FALSE(state.converged());
  config.patience = 2;
  config.progress = 100.0;  // more than any cost can fall by
  state = RunIterations(Mppi(ruler.Make(1, 1), config), 2, 1);
  EXPECT_FALSE(state.ended());
  state = RunIterations(Mppi(ruler.Make(1, 1), config), 3, 1);
  EXPECT_EQ(state.end, MppiEnd::kPatience);  // and not the limit, which is reached as well
  EXPECT_TRUE(state.converged());
}

TEST(MppiTest, APlanWithoutContactIsTheWorstKindOfRest) {
  const RulerProblem ruler;
  const Mppi mppi(ruler.Make(2, 1), QuickConfig());
  std::vector<double> action(mppi.Start().mean.size(), -5.0);  // all fingers off
  const PlanOutcome outcome = mppi.Simulate(action);
  EXPECT_EQ(outcome.contact_seconds, 0.0);
  const auto states = StatesToScore(ruler.world, outcome);
  const auto scores = ruler.scorer.Score(states);
  const std::vector<ScoredState> end = {EndToScore(ruler.world, outcome)};
  const PlanCost cost =
      CalcPlanCost(ruler.world, outcome, scores, ruler.scorer.ScoreGraspable(end)[0], 0.0,
                   CostWeights(), 0.7, 0.1);
  EXPECT_EQ(cost.no_contact, CostWeights().no_contact);
  EXPECT_NEAR(cost.total, CostWeights().no_contact, 1e-3);
}

TEST(MppiTest, TheScaleOfScoresIsThatOfTheFirstIterationAndCostsCompareFromThenOn) {
  const RulerProblem ruler;
  const Mppi mppi(ruler.Make(2, 3), QuickConfig());
  EXPECT_EQ(mppi.Start().score_scale, 0.0);
  const MppiState first = RunIterations(mppi, 1, 1);
  std::vector<double> rewards;
  for (const MppiSample& sample : first.samples) rewards.push_back(sample.cost.reward);
  EXPECT_EQ(first.score_scale, CalcScoreScale(rewards));
  const MppiState later = RunIterations(mppi, 4, 1);
  EXPECT_EQ(later.score_scale, first.score_scale);
  // The best plan of the first iteration, met again as a sample of the second, costs the same.
  EXPECT_EQ(RunIterations(mppi, 2, 1).samples[1].cost.total, first.best_cost);
}

TEST(MppiTest, DoingNothingIsWorthWhatTheStartIs) {
  const RulerProblem ruler;
  // Its end stands 1 cm inboard: OverhangScorer gives 0 there.
  EXPECT_NEAR(Mppi(ruler.Make(2, 1), QuickConfig()).Start().rest_reward, 0.0, 1e-3);
}

TEST(MppiTest, PatienceBeginsWithTheFirstRise) {
  const RulerProblem ruler;
  MppiConfig config = QuickConfig();
  config.iterations = 5;
  config.patience = 1;
  config.progress = 100.0;
  config.rise = 100.0;  // never
  EXPECT_EQ(RunIterations(Mppi(ruler.Make(2, 1), config), 5, 1).end, MppiEnd::kLimit);
  config.rise = 0.0;
  const MppiState state = RunIterations(Mppi(ruler.Make(2, 1), config), 2, 1);
  EXPECT_EQ(state.rose_at, 1);
  EXPECT_EQ(state.end, MppiEnd::kPatience);
}

TEST(MppiTest, ThePlansToChooseFromEndApartBestFirst) {
  const RulerProblem ruler;
  const MppiState state = RunIterations(Mppi(ruler.Make(2, 2), QuickConfig()), 5, 1);
  ASSERT_GE(state.plans.size(), 2U);
  ASSERT_LE(state.plans.size(), static_cast<std::size_t>(kMostPlans));
  EXPECT_EQ(state.plans[0].action, state.best_action);
  EXPECT_EQ(state.plans[0].cost.total, state.best_cost);
  for (std::size_t i = 1; i < state.plans.size(); ++i) {
    EXPECT_GE(state.plans[i].cost.total, state.plans[i - 1].cost.total);
    for (std::size_t j = 0; j < i; ++j) {
      const RigidTransform &a = state.plans[i].X_WO_end, &b = state.plans[j].X_WO_end;
      EXPECT_TRUE((a.translation() - b.translation()).norm() >= kSameShift ||
                  RadToDeg(RotationAngle(a.linear(), b.linear())) >= kSameTurnDeg);
    }
  }
}

TEST(MppiTest, TheBetterHalfIsTriedInOtherWorldsAndTheRestCountsAsMostFragile) {
  const RulerProblem ruler;
  const std::vector<World> others = MakeExtremeWorlds(ruler.scene, ruler.world.config());
  MppiProblem problem = ruler.Make(2, 2);
  const MppiState alone = RunIterations(Mppi(problem, QuickConfig()), 1, 1);
  problem.others = &others;
  const Mppi mppi(problem, QuickConfig());
  const MppiState state = RunIterations(mppi, 1, 1);
  ExpectSameBits(state, RunIterations(mppi, 1, 2));

  const double weight = mppi.config().weights.fragility;
  const auto loss = [&](const MppiSample& sample) {
    return weight * std::max(sample.cost.reward - state.rest_reward, 0.0);
  };
  std::vector<std::pair<double, int>> order;
  for (int i = 0; i < std::ssize(alone.samples); ++i) {
    EXPECT_EQ(alone.samples[i].action, state.samples[i].action);
    EXPECT_EQ(alone.samples[i].cost.fragility, 0.0);
    order.emplace_back(alone.samples[i].cost.total, i);
  }
  std::sort(order.begin(), order.end());
  int tried = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const MppiSample& sample = state.samples[order[k].second];
    EXPECT_NEAR(sample.cost.total, order[k].first + sample.cost.fragility, 1e-12);
    if (k < order.size() / 2) {
      std::vector<PlanOutcome> outcomes;
      const PlanOutcome nominal = mppi.Simulate(sample.action);
      for (const World& world : others) {
        outcomes.push_back(SimulatePlan(world, ruler.environment, problem.start, nominal.plan,
                                        mppi.config().timing, Stepper::kKernel));
      }
      const double fragility = CalcFragility(nominal, outcomes);
      EXPECT_NEAR(sample.cost.fragility, fragility * loss(sample), 1e-12);
      tried += fragility < 1.0 && loss(sample) > 0.0 ? 1 : 0;
    } else {
      EXPECT_NEAR(sample.cost.fragility, loss(sample), 1e-12);
    }
  }
  EXPECT_GE(tried, 1);
}

TEST(MppiTest, WhatFollowsScreeningBeginsWithItsPlansAndCountsFromOne) {
  const RulerProblem ruler;
  MppiConfig few = QuickConfig();
  few.samples = 8;
  const Mppi screening(ruler.Make(2, 4), few), mppi(ruler.Make(2, 4), QuickConfig());
  ThreadPool pool(2);
  MppiState state = screening.Start();
  screening.Screen(state, 2, pool);
  screening.Screen(state, 1, pool);
  EXPECT_EQ(state.screened, 3);
  EXPECT_EQ(state.iteration, 0);
  EXPECT_FALSE(state.ended());
  const double screened = state.best_cost, scale = state.score_scale;
  mppi.Step(state, pool);
  EXPECT_EQ(state.iteration, 1);
  EXPECT_EQ(state.best_history.size(), 1U);
  EXPECT_LE(state.best_cost, screened);
  EXPECT_EQ(state.score_scale, scale);
  EXPECT_EQ(state.samples[1].cost.total, screened);
}

TEST(MppiTest, AFingerThatFitsNowhereOnItsTriangleStaysAway) {
  const RulerProblem ruler;
  MppiProblem problem = ruler.Make(2, 1);
  const int bottom = 8 * 2;  // the strip's first triangle, which lies on the table
  problem.path.nodes = {bottom * ruler.graph.num_triangles() + bottom,
                        bottom * ruler.graph.num_triangles() + bottom};
  const Mppi mppi(problem, QuickConfig());
  const PlanOutcome outcome = mppi.Simulate(std::vector<double>(mppi.Start().mean.size(), 1.0));
  EXPECT_EQ(outcome.contact_seconds, 0.0);
  EXPECT_EQ(outcome.max_tip_overlap, 0.0);
  for (const auto& stage : outcome.plan.stages) {
    for (const WorldPlan::Finger& finger : stage) EXPECT_FALSE(finger.on || finger.kept);
  }
}

TEST(MppiTest, AConfigurationThatNoSettingGivesIsOurBug) {
  const RulerProblem ruler;
  MppiConfig few, nowhere;
  few.samples = 1;
  nowhere.temperature = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Mppi(ruler.Make(0, 1), few), InternalError);
  EXPECT_THROW(Mppi(ruler.Make(0, 1), nowhere), InternalError);
}

TEST(MppiTest, ACostThatIsNoNumberIsOurBugAndNeverTheBestPlan) {
  const RulerProblem ruler;
  MppiConfig config;
  config.samples = 4;
  config.weights.no_contact = config.weights.effort = std::numeric_limits<double>::quiet_NaN();
  const Mppi mppi(ruler.Make(0, 1), config);
  MppiState state = mppi.Start();
  ThreadPool pool(1);
  EXPECT_THROW(mppi.Step(state, pool), InternalError);
  EXPECT_TRUE(state.best_action.empty());
}

}  // namespace
}  // namespace pregrasp
