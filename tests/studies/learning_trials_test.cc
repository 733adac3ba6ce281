#include "app/studies/learning_trials.h"

#include <gtest/gtest.h>

#include "app/core/data_folder.h"
#include "app/core/error.h"
#include "app/networks/safetensors.h"
#include "app/training/make_item.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

const GraspLibrary& Library() {
  static const GraspLibrary library = [] {
    ThreadPool pool(2);
    return GraspLibrary({"can", "rod"}, 1, 5, pool);
  }();
  return library;
}

fs::path Weights() { return DataFolder() / "assets" / "weights"; }

TEST(LearningTrialsTest, TheShippedScoreKnowsFamiliesThatItNeverSaw) {
  const std::vector<std::string> held_out = ReadHeldOutFamilies(Weights());
  ASSERT_GE(held_out.size(), 5U);
  const auto facts =
      JudgeScore(DataFolder() / "assets" / "training" / "states.safetensors.gz", Weights());
  EXPECT_EQ(facts["families"].size(), held_out.size());
  EXPECT_GT(facts["all"]["labels"], 30'000);
  EXPECT_GT(facts["all"]["r2"], 0.6);
  EXPECT_GT(facts["all"]["rank"], 0.75);
  EXPECT_GT(facts["all"]["auc"], 0.8);
  EXPECT_LT(facts["all"]["calibration"], 0.08);
  for (const auto& [family, own] : facts["families"].items()) EXPECT_GT(own["r2"], 0.3) << family;
}

TEST(LearningTrialsTest, GeneratedGraspsAreBetterThanRandomPoints) {
  ThreadPool pool(2);
  int generated = 0, random = 0, samples = 0;
  const auto facts =
      TryGenerator(nullptr, ItemOfFamily("flask", 0), 7, Weights(), Library(), pool, {.grasps = 4});
  for (const auto& [name, counts] : facts["generator"].items()) {
    EXPECT_EQ(counts["overlapping"], 0) << name;
    for (const char* other : {"random", "nearest", "single_draw"}) {
      EXPECT_EQ(counts["samples"], facts[other][name]["samples"]);
    }
    samples += counts["samples"].get<int>();
    generated += counts["raw"].get<int>();
    random += facts["random"][name]["raw"].get<int>();
  }
  ASSERT_GE(samples, 48);
  EXPECT_GT(generated, 2 * random);
}

TEST(LearningTrialsTest, ATrialIsAFunctionOfItsArguments) {
  const auto run = [](int threads) {
    ThreadPool pool(threads);
    return TryGenerator(nullptr, ItemOfFamily("wedge", 1), 3, Weights(), Library(), pool,
                        {.grasps = 1, .samples = 2});
  };
  EXPECT_EQ(run(1), run(2));
}

TEST(LearningTrialsTest, GivenObjectsGetLabelsAndSamples) {
  const TrainingObject can{"can", "can", Cylinder{0.03, 0.10}, 0.3};
  const TrainingObject rod{"rod", "rod", Cylinder{0.012, 0.16}, 0.03};
  const auto objects =
      std::make_shared<const std::vector<TrainingObject>>(std::vector<TrainingObject>{can, rod});
  ThreadPool pool(2);
  const auto judged =
      JudgeObjects(objects, 1, 2, 4, Weights(), Library(), pool,
                   {.grasps = 1, .samples = 1, .pushes = 8, .states = 2})["objects"];
  ASSERT_EQ(judged.size(), 1U);
  EXPECT_EQ(judged[0]["object"], "rod");
  EXPECT_GT(judged[0]["truth"].size(), 50U);
  for (const char* list : {"score", "lifted", "probability"}) {
    EXPECT_EQ(judged[0][list].size(), judged[0]["truth"].size());
  }
  EXPECT_GT(judged[0]["generator"]["both"]["samples"], 0);
}

TEST(LearningTrialsTest, WeightsThatHeldNothingOutAreRefused) {
  const fs::path folder = fs::path(testing::TempDir()) / "seen_all";
  fs::create_directories(folder);
  TensorFile file = ReadTensors(Weights() / "score.safetensors");
  file.metadata["training"] = R"({"validation":[]})";
  WriteTensors(folder / "score.safetensors", file);
  EXPECT_THROW(ReadHeldOutFamilies(folder), InputError);
}

TEST(LearningTrialsTest, ScoringTakesTime) { EXPECT_GT(TimeScore(Weights()), 0.0); }

}  // namespace
}  // namespace pregrasp
