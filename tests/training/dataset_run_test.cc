#include "app/training/dataset_run.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>

#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/core/sha256.h"
#include "tests/networks/random_network.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

std::map<std::string, std::string> ReadFiles(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".partial" || entry.is_directory()) continue;
    std::ifstream in(entry.path(), std::ios::binary);
    files[entry.path().filename().string()] =
        std::string(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  return files;
}

// Four objects in one scene each, with few tests.
ItemConfig SmallConfig() {
  ItemConfig config;
  config.seed = 5;
  config.scenes = 1;
  config.points = 128;
  config.growth.max_tests = 6;
  config.growth.search.max_found = 2;
  config.growth.search.max_sets = 4096;
  config.growth.search.max_solves = 16;
  config.labels.per_scene = 3;
  config.labels.tries = 1;
  config.labels.completion.max_solves = 1;
  return config;
}

class DatasetRunTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(::testing::TempDir()) / (std::string("dataset_run_") + test->name());
    fs::remove_all(folder_);
    ClearInterrupt();
  }
  void TearDown() override { fs::remove_all(folder_); }

  DatasetRun Shard(const std::string& name, int shard = 1, int shards = 1) const {
    DatasetRun run;
    run.items = 4;
    run.shard = {shard, shards};
    run.folder = folder_ / name;
    run.threads = 1;
    return run;
  }

  fs::path folder_;
};

TEST_F(DatasetRunTest, ShardsAndOneRunMergeToTheSameBytes) {
  MakeGraspItems(Shard("whole"), SmallConfig(), {});
  MakeGraspItems(Shard("a", 1, 2), SmallConfig(), {});
  MakeGraspItems(Shard("b", 2, 2), SmallConfig(), {});
  MergeDataset({folder_ / "whole"}, 4, folder_ / "merged whole");
  MergeDataset({folder_ / "b", folder_ / "a"}, 4, folder_ / "merged shards");
  EXPECT_EQ(ReadFiles(folder_ / "merged whole"), ReadFiles(folder_ / "merged shards"));
  const Dataset dataset = ReadDataset(folder_ / "merged whole");
  std::size_t grasps = 0;
  for (const DatasetItem& item : dataset.items) grasps += item.grasps.size();
  EXPECT_GT(grasps, 0);
}

TEST_F(DatasetRunTest, ARunThatWasCutOffGoesOnToTheSameBytes) {
  MakeGraspItems(Shard("whole"), SmallConfig(), {});
  const auto interrupt = [](const BatchProgress& progress) {
    if (progress.done == 2) RequestInterrupt();
  };
  EXPECT_THROW(MakeGraspItems(Shard("cut"), SmallConfig(), interrupt), Interrupted);
  ClearInterrupt();
  // As a kill in the middle of writing leaves it.
  std::ofstream(folder_ / "cut" / "item-000002.safetensors.partial") << "half";
  std::int64_t found = -1;
  MakeGraspItems(Shard("cut"), SmallConfig(), [&](const BatchProgress& progress) {
    if (found < 0) found = progress.done;
  });
  EXPECT_EQ(found, 2);
  EXPECT_EQ(ReadFiles(folder_ / "whole"), ReadFiles(folder_ / "cut"));
}

TEST_F(DatasetRunTest, LabelsAreSharesAndKnowWhatTheyWereMadeFrom) {
  const ItemConfig config = SmallConfig();
  MakeGraspItems(Shard("grasps"), config, {});
  MergeDataset({folder_ / "grasps"}, 4, folder_ / "merged");
  WriteTensors(folder_ / "generator.safetensors", MakeRandomGenerator(1));
  MakeLabelItems(Shard("labels"), config, folder_ / "merged", folder_ / "generator.safetensors",
                 {});
  MergeDataset({folder_ / "labels"}, 4, folder_ / "labelled");
  const Dataset dataset = ReadDataset(folder_ / "labelled");
  for (const DatasetItem& item : dataset.items) {
    ASSERT_EQ(item.labels.size(), 3);
    for (int l = 0; l < 3; ++l) {
      const LabelRecord& label = item.labels[l];
      EXPECT_EQ(GeneratorOf(label.contacts), l);  // thumb, index, both in turn
      EXPECT_EQ(item.contexts[label.context].relief, 0.0);
      EXPECT_EQ(label.tries, config.labels.tries);
      for (const int feasible : label.feasible) EXPECT_LE(feasible, label.tries);
    }
  }
  ItemConfig other = config;
  other.seed = 6;
  EXPECT_THROW(MakeLabelItems(Shard("other"), other, folder_ / "merged",
                              folder_ / "generator.safetensors", {}),
               InputError);
}

TEST_F(DatasetRunTest, ItemsOfTwoBuildsDoNotMerge) {
  MakeGraspItems(Shard("a", 1, 2), SmallConfig(), {});
  MakeGraspItems(Shard("b", 2, 2), SmallConfig(), {});
  const fs::path description = folder_ / "b" / "description.json";
  auto json = nlohmann::ordered_json::parse(ReadWholeFile(description));
  EXPECT_EQ(json.at("program"), Sha256OfProgram());
  json["program"] = std::string(64, '0');
  WriteWholeFile(description, json.dump());
  try {
    MergeDataset({folder_ / "a", folder_ / "b"}, 4, folder_ / "merged");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("program: "), std::string::npos) << error.what();
  }
  EXPECT_FALSE(fs::exists(folder_ / "merged"));
  EXPECT_THROW(MergeDataset({folder_ / "a"}, 4, folder_ / "merged"), InputError);
  EXPECT_FALSE(fs::exists(folder_ / "merged"));
  // Nor are items of this build made among those of another.
  EXPECT_THROW(MakeGraspItems(Shard("b"), SmallConfig(), {}), InputError);
}

TEST_F(DatasetRunTest, CountingMakesNothing) {
  MakeGraspItems(Shard("x", 1, 4), SmallConfig(), {});
  const auto before = ReadFiles(folder_ / "x");
  DatasetRun run = Shard("x");
  run.only_count = true;
  BatchProgress counted;
  MakeGraspItems(run, SmallConfig(), [&](const BatchProgress& progress) { counted = progress; });
  EXPECT_EQ(counted.items, 4);
  EXPECT_EQ(counted.total, 4);
  EXPECT_EQ(counted.done, 1);
  EXPECT_EQ(ReadFiles(folder_ / "x"), before);
  run.folder = folder_ / "nowhere";
  MakeGraspItems(run, SmallConfig(), {});
  EXPECT_FALSE(fs::exists(run.folder));
}

TEST_F(DatasetRunTest, NonsenseIsRefused) {
  DatasetRun run = Shard("none");
  run.shard = {3, 2};
  EXPECT_THROW(MakeGraspItems(run, SmallConfig(), {}), InputError);
  EXPECT_FALSE(fs::exists(run.folder));
}

}  // namespace
}  // namespace pregrasp
