#include "app/training/metrics.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pregrasp {
namespace {

TEST(MetricsTest, R2IsOneForTheTruthAndZeroForItsMean) {
  const std::vector<double> truth = {0.0, 0.2, 0.9, 0.5};
  EXPECT_DOUBLE_EQ(CalcR2(truth, truth), 1.0);
  EXPECT_NEAR(CalcR2(truth, {0.4, 0.4, 0.4, 0.4}), 0.0, 1e-12);
  EXPECT_LT(CalcR2(truth, {0.9, 0.5, 0.0, 0.2}), 0.0);
  EXPECT_EQ(CalcR2({0.3, 0.3}, {0.1, 0.5}), 0.0);
}

TEST(MetricsTest, RankCorrelationSeesTheOrderOnly) {
  const std::vector<double> a = {0.1, 0.4, 0.2, 0.9};
  std::vector<double> b;
  for (const double x : a) b.push_back(std::exp(5.0 * x));
  EXPECT_NEAR(CalcRankCorrelation(a, b), 1.0, 1e-12);
  for (double& x : b) x = -x;
  EXPECT_NEAR(CalcRankCorrelation(a, b), -1.0, 1e-12);
  // With ties: ranks 0.5 0.5 2 against 0 1 2 have correlation 1.5 / sqrt(1.5 * 2).
  EXPECT_NEAR(CalcRankCorrelation({1.0, 1.0, 2.0}, {1.0, 2.0, 3.0}), 1.5 / std::sqrt(3.0), 1e-12);
  EXPECT_EQ(CalcRankCorrelation({1.0, 1.0}, {0.0, 1.0}), 0.0);
}

TEST(MetricsTest, CalibrationCountsEveryPredictionOnce) {
  const auto curve = CalcCalibration({0.0, 0.4, 1.0, 1.0}, {0.05, 0.15, 0.95, 1.0}, 10);
  ASSERT_EQ(curve.size(), 10U);
  EXPECT_EQ(curve[0].count, 1);
  EXPECT_EQ(curve[9].count, 2);
  EXPECT_DOUBLE_EQ(curve[9].mean_prediction, 0.975);
  EXPECT_DOUBLE_EQ(curve[9].mean_truth, 1.0);
  EXPECT_DOUBLE_EQ(curve[1].mean_truth, 0.4);
}

TEST(MetricsTest, TheAreaUnderTheCurveCountsPairs) {
  EXPECT_DOUBLE_EQ(CalcAuc({0, 0, 1, 1}, {0.1, 0.4, 0.35, 0.8}), 0.75);
  EXPECT_DOUBLE_EQ(CalcAuc({0, 1}, {0.5, 0.5}), 0.5);
  EXPECT_DOUBLE_EQ(CalcAuc({1, 0}, {0.9, 0.1}), 1.0);
  EXPECT_DOUBLE_EQ(CalcAuc({1, 1}, {0.9, 0.1}), 0.5);
}

TEST(MetricsTest, TheCalibrationErrorIsThatOfEquallyFullBins) {
  // Two bins of two: the first is right on the average, the second says 0.3 too much.
  EXPECT_NEAR(CalcCalibrationError({0, 0, 1, 0}, {0.0, 0.0, 0.7, 0.9}, 2), 0.5 * 0.3, 1e-12);
  EXPECT_DOUBLE_EQ(CalcCalibrationError({}, {}), 0.0);
}

}  // namespace
}  // namespace pregrasp
