#include "app/studies/statistics.h"

#include <gtest/gtest.h>

namespace pregrasp {
namespace {

TEST(MeanDeviationTest, IsThatOfTheSample) {
  const MeanDeviation result = CalcMeanDeviation({2.0, 4.0, 4.0, 6.0});
  EXPECT_DOUBLE_EQ(*result.mean, 4.0);
  EXPECT_DOUBLE_EQ(*result.deviation, std::sqrt(8.0 / 3.0));
  EXPECT_FALSE(CalcMeanDeviation({3.0}).deviation.has_value());
  EXPECT_DOUBLE_EQ(*CalcMeanDeviation({3.0}).mean, 3.0);
  EXPECT_FALSE(CalcMeanDeviation({}).mean.has_value());
}

TEST(MedianTest, IsTheMiddle) {
  EXPECT_DOUBLE_EQ(*CalcMedian({9.0, 1.0, 5.0}), 5.0);
  EXPECT_DOUBLE_EQ(*CalcMedian({9.0, 1.0, 5.0, 6.0}), 5.5);
  EXPECT_FALSE(CalcMedian({}).has_value());
}

// Both ends solve (p - share)^2 = z^2 p (1 - p) / n, which is what the interval is.
TEST(WilsonIntervalTest, EndsSolveTheScoreEquation) {
  for (const auto& [successes, count] : {std::pair(4, 5), std::pair(1, 3), std::pair(7, 10)}) {
    const auto [low, high] = CalcWilsonInterval(successes, count);
    for (const double p : {low, high}) {
      const double share = static_cast<double>(successes) / count;
      EXPECT_NEAR((p - share) * (p - share), 3.841458820694124 * p * (1.0 - p) / count, 1e-12);
    }
    EXPECT_LT(low, high);
  }
}

TEST(WilsonIntervalTest, StaysWithinZeroAndOneAndMirrors) {
  const auto [none_low, none_high] = CalcWilsonInterval(0, 5);
  const auto [all_low, all_high] = CalcWilsonInterval(5, 5);
  EXPECT_EQ(none_low, 0.0);
  EXPECT_EQ(all_high, 1.0);
  EXPECT_NEAR(none_high, 1.0 - all_low, 1e-12);
  EXPECT_NEAR(none_high, 0.4345, 1e-4);  // z^2 / (n + z^2)
}

}  // namespace
}  // namespace pregrasp
