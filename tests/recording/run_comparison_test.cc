#include "app/recording/run_comparison.h"

#include <gtest/gtest.h>

#include "app/core/error.h"
#include "app/job/facts_json.h"
#include "app/recording/gzip_file.h"
#include "app/recording/rawlog.h"
#include "tests/recording/alteration.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

constexpr int kStepsCompared = 12;

// Two runs that are the same but for what a test does to the first.
class RunComparisonTest : public testing::Test {
 protected:
  RunComparisonTest() {
    WriteSampleRun(left_, kStepsCompared, 3);
    WriteSampleRun(right_, kStepsCompared, 0);
  }

  std::optional<RunDifference> First(double tolerance = 0.0) const {
    RunComparison comparison(tolerance);
    comparison.CompareRuns(left_, right_);
    return comparison.first();
  }
  void Restore(const std::string& file) const {
    fs::copy_file(right_ / file, left_ / file, fs::copy_options::overwrite_existing);
  }

  const TemporaryFolder folder_;
  const fs::path left_ = folder_.path() / "left", right_ = folder_.path() / "right";
};

TEST_F(RunComparisonTest, TheSameRunWithAndWithoutPicturesIsTheSame) {
  EXPECT_FALSE(First().has_value());
}

TEST_F(RunComparisonTest, EachOfTwentyFieldsOfStepsIsNamedWithItsStep) {
  Rng rng(3);
  for (int i = 0; i < 20; ++i) {
    const Alteration altered = AlterRandomField(left_ / "steps.jsonl", rng);
    const auto first = First();
    ASSERT_TRUE(first.has_value()) << altered.id << ' ' << altered.field;
    EXPECT_EQ(first->place, altered.id);
    EXPECT_EQ(first->value.field, altered.field);
    EXPECT_NE(first->value.left, first->value.right);
    Restore("steps.jsonl");
  }
}

TEST_F(RunComparisonTest, EachOfTwentyFieldsOfTheJournalIsNamedWithItsLine) {
  Rng rng(4);
  for (int i = 0; i < 20; ++i) {
    const Alteration altered = AlterRandomField(left_ / "journal.jsonl", rng);
    const auto first = First();
    ASSERT_TRUE(first.has_value()) << altered.line << ' ' << altered.field;
    EXPECT_EQ(first->place, "journal.jsonl, line " + std::to_string(altered.line + 1));
    EXPECT_EQ(first->value.field, altered.field);
    Restore("journal.jsonl");
  }
}

TEST_F(RunComparisonTest, EachOfTwentyCellsOfATableIsNamedWithItsLineAndColumn) {
  Rng rng(5);
  for (int i = 0; i < 20; ++i) {
    const std::string altered = AlterRandomCell(left_ / "rollout.csv", rng);
    const auto first = First();
    ASSERT_TRUE(first.has_value()) << altered;
    EXPECT_EQ(first->place + ": " + first->value.field, "rollout.csv, " + altered);
    Restore("rollout.csv");
  }
}

TEST_F(RunComparisonTest, EachOfTwentyBytesOfTheLogIsFound) {
  const std::string bytes = ReadGzipFile(right_ / "run.rawlog");
  Rng rng(6);
  for (int i = 0; i < 20; ++i) {
    std::string altered = bytes;
    altered[rng.UniformInt(static_cast<std::uint32_t>(bytes.size()))] ^=
        static_cast<char>(1U << rng.UniformInt(8));
    GzipFile file(left_ / "run.rawlog");
    file.Write(altered);
    file.Close();
    const auto first = First();
    ASSERT_TRUE(first.has_value()) << i;
    EXPECT_EQ(first->place.rfind("run.rawlog", 0), 0U) << first->place;
  }
}

TEST_F(RunComparisonTest, AStepOfTheLogAloneThatIsAlteredIsNamedWithItsField) {
  RawlogWriter log(left_ / "run.rawlog", {});
  for (int i = 0; i < kStepsCompared; ++i) {
    StepFacts step = SampleStep(i);
    if (i == 7) step.fingers[1].f_W.x() += 1e-12;
    log.Add(step, FormatJson(FactsToJson(step, i + 1)));
  }
  log.Close();
  const auto first = First();
  ASSERT_TRUE(first.has_value());
  EXPECT_EQ(first->place, "run.rawlog, sim.7");
  EXPECT_EQ(first->value.field, "fingers[1].f_W[0]");
}

TEST_F(RunComparisonTest, WhatDecidesNothingIsNotCompared) {
  nlohmann::ordered_json summary = nlohmann::ordered_json::parse(ReadFile(left_ / "summary.json"));
  summary["seconds"]["total"] = 17.5;
  summary["peak_rss_mb"] = 3.0;
  WriteFile(left_ / "summary.json", FormatJsonIndented(summary));
  EXPECT_FALSE(First().has_value());
  summary["status"] = "ok";
  WriteFile(left_ / "summary.json", FormatJsonIndented(summary));
  EXPECT_EQ(First()->Sentence("one says", "the other"),
            "summary.json: status: one says \"ok\", the other \"interrupted\"");
}

TEST_F(RunComparisonTest, SettingsSeedAndEndAreComparedAndAFileTooMuchOrTooFewIsNamed) {
  for (const char* field : {"seed", "step", "settings_at_start", "configuration"}) {
    nlohmann::ordered_json manifest =
        nlohmann::ordered_json::parse(ReadFile(right_ / "manifest.json"));
    manifest[field] = "another";
    WriteFile(left_ / "manifest.json", FormatJsonIndented(manifest));
    ASSERT_TRUE(First().has_value()) << field;
    EXPECT_EQ(First()->value.field, field);
  }
  Restore("manifest.json");
  WriteFile(left_ / "lift.csv", "t\n");
  EXPECT_EQ(First()->Sentence("there is", "here"), "lift.csv: there is a file, here nothing");
  fs::remove(left_ / "lift.csv");
  fs::remove(left_ / "meshes/object.obj");
  EXPECT_EQ(First()->place, "meshes/object.obj");
}

TEST_F(RunComparisonTest, TheSameValuesInOtherBytesAreADifference) {
  WriteFile(left_ / "scene.json", ReadFile(right_ / "scene.json") + " ");
  EXPECT_EQ(First()->Sentence("has", "not"), "scene.json: has other bytes, not its bytes");
}

TEST_F(RunComparisonTest, WithATolerancesNumbersMayDifferButNoDecision) {
  const auto alter = [&](double by, bool on) {
    std::vector<std::string> lines = SplitLines(ReadFile(right_ / "steps.jsonl"));
    nlohmann::ordered_json step = nlohmann::ordered_json::parse(lines[4]);
    double& x = step["fingers"][0]["f_W"][2].get_ref<double&>();
    x += by;
    if (on) step["fingers"][0]["on"] = !step["fingers"][0]["on"].get<bool>();
    lines[4] = FormatJson(step);
    WriteFile(left_ / "steps.jsonl", JoinLines(lines));
    RunComparison comparison(1e-6);
    comparison.CompareRuns(left_, right_);
    return comparison;
  };
  const RunComparison little = alter(1e-9, false);
  EXPECT_FALSE(little.first().has_value());
  ASSERT_TRUE(little.largest().has_value());
  EXPECT_EQ(little.largest()->place, "sim.4");
  EXPECT_NEAR(*little.largest()->value.distance, 1e-9, 1e-9);
  const RunComparison much = alter(0.5, false);
  ASSERT_TRUE(much.first().has_value());
  EXPECT_EQ(much.first()->value.field, "fingers[0].f_W[2]");
  EXPECT_FALSE(much.decision().has_value());
  const RunComparison other = alter(1e-9, true);
  ASSERT_TRUE(other.decision().has_value());
  EXPECT_EQ(other.decision()->value.field, "fingers[0].on");
  EXPECT_EQ(other.first()->value.field, "fingers[0].on");
}

TEST_F(RunComparisonTest, PicturesMustBeThoseOfSteps) {
  EXPECT_FALSE(FindFaultOfPictures(left_).has_value());
  EXPECT_FALSE(FindFaultOfPictures(right_).has_value());
  WriteFile(left_ / "frames/0009_sim-8.png", kOnePixelPng);
  EXPECT_EQ(FindFaultOfPictures(left_)->place, "pictures.jsonl");
  fs::remove(left_ / "frames/0009_sim-8.png");
  fs::rename(left_ / "frames/0002_sim-1.png", left_ / "frames/0009_sim-8.png");
  EXPECT_EQ(FindFaultOfPictures(left_)->value.field, "line 2");
}

}  // namespace
}  // namespace pregrasp
