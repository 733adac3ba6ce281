#include "app/studies/label_noise.h"

#include <gtest/gtest.h>

#include "app/training/make_item.h"

namespace pregrasp {
namespace {

nlohmann::json Labels(std::vector<std::vector<double>> progress,
                      std::vector<std::vector<double>> lifted) {
  return {{"progress", std::move(progress)}, {"lifted", std::move(lifted)}};
}

TEST(LabelNoiseTest, LabelsThatRepeatLeaveEverythingToBeLearned) {
  const auto ceiling = CalcLabelCeiling({Labels({{0.1, 0.1, 0.1}, {0.5, 0.5, 0.5}}, {{0, 0, 0}}),
                                         Labels({{0.9, 0.9, 0.9}}, {{1, 1, 1}})});
  EXPECT_EQ(ceiling["labels"], 3);
  EXPECT_EQ(ceiling["repeats"], 3);
  EXPECT_DOUBLE_EQ(ceiling["r2"], 1.0);
  EXPECT_DOUBLE_EQ(ceiling["rank"], 1.0);
  EXPECT_DOUBLE_EQ(ceiling["auc"], 1.0);
}

// Labels of one distribution: nothing of a repeat is in the others.
TEST(LabelNoiseTest, LabelsOfPureChanceLeaveNothing) {
  Rng rng(3);
  std::vector<std::vector<double>> progress, lifted;
  for (int i = 0; i < 2000; ++i) {
    progress.push_back({rng.Uniform(), rng.Uniform(), rng.Uniform(), rng.Uniform()});
    lifted.emplace_back();
    for (int r = 0; r < 4; ++r) lifted.back().push_back(rng.Uniform() < 0.3 ? 1.0 : 0.0);
  }
  const auto ceiling = CalcLabelCeiling({Labels(progress, lifted)});
  EXPECT_NEAR(ceiling["r2"], 0.0, 0.03);
  EXPECT_NEAR(ceiling["rank"], 0.0, 0.05);
  EXPECT_NEAR(ceiling["auc"], 0.5, 0.03);
}

// y = x + noise of the same variance: half of the variance can be known.
TEST(LabelNoiseTest, HalfNoiseIsHalfOfTheVariance) {
  Rng rng(4);
  std::vector<std::vector<double>> progress;
  for (int i = 0; i < 5000; ++i) {
    const double x = rng.Uniform();
    progress.push_back({x + rng.Uniform(), x + rng.Uniform(), x + rng.Uniform()});
  }
  EXPECT_NEAR(CalcLabelCeiling({Labels(progress, {{0, 0, 0}})})["r2"], 0.5, 0.03);
}

TEST(LabelNoiseTest, RepeatsAreOfTheSameContactsAndAFunctionOfTheArguments) {
  const auto repeat = [](int threads) {
    ThreadPool pool(threads);
    return RepeatLabels(ItemOfFamily("mug", 0), 5, true, pool,
                        {.repeats = 2, .pushes = 8, .states = 2});
  };
  const auto labels = repeat(1);
  EXPECT_EQ(labels, repeat(2));
  EXPECT_EQ(labels["family"], "mug");
  ASSERT_GT(labels["progress"].size(), 40U);
  ASSERT_EQ(labels["lifted"].size(), labels["progress"].size());
  int differ = 0;
  for (const auto& one : labels["progress"]) {
    ASSERT_EQ(one.size(), 2U);
    differ += one[0] != one[1];
  }
  EXPECT_GT(differ, 0);
  EXPECT_GT(CalcLabelCeiling({labels})["r2"], 0.5);
}

}  // namespace
}  // namespace pregrasp
