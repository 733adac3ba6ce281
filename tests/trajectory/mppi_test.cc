#include "app/trajectory/mppi.h"

#include <gtest/gtest.h>

#include <limits>

#include "app/core/error.h"
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
  const PlanCost cost = CalcPlanCost(ruler.world, outcome, scores,
                                     ruler.scorer.ScoreGraspable(end)[0], CostWeights(), 0.7, 0.1);
  EXPECT_EQ(cost.no_contact, CostWeights().no_contact);
  EXPECT_NEAR(cost.total, CostWeights().no_contact, 1e-3);
}

TEST(PlanCostTest, TheTipsOverlapCostsByItsDepthUpToAFingertipsRadius) {
  const RulerProblem ruler;
  const Mppi mppi(ruler.Make(2, 1), QuickConfig());
  PlanOutcome outcome = mppi.Simulate(std::vector<double>(mppi.Start().mean.size(), -5.0));
  const std::vector<double> scores(StatesToScore(ruler.world, outcome).size(), 0.0);
  const auto cost_at = [&](double gap) {
    outcome.min_tip_gap = gap;
    return CalcPlanCost(ruler.world, outcome, scores, 0.0, CostWeights(), 0.7, 0.1).tip_spacing;
  };
  EXPECT_EQ(cost_at(0.1), 0.0);
  EXPECT_EQ(cost_at(0.0), 0.0);
  EXPECT_NEAR(cost_at(-0.0001), CostWeights().tip_spacing / 90.0, 1e-12);
  EXPECT_NEAR(cost_at(-0.0045), CostWeights().tip_spacing / 2.0, 1e-12);
  EXPECT_EQ(cost_at(-0.0199), CostWeights().tip_spacing);
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
