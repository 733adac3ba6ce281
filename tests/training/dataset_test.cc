#include "app/training/dataset.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "app/core/error.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

constexpr int kPoints = 20;

Vector3 RandomVector(Rng& rng) { return 0.1 * rng.Direction(); }

// A stand-in for what a generator of data would make of item `index`.
DatasetItem MakeItem(std::int64_t index) {
  Rng rng(1, RngStream::kTest, static_cast<std::uint32_t>(index));
  DatasetItem item;
  item.index = index;
  item.family = index % 3 ? "box" : "can";
  item.name = item.family + " " + std::to_string(index);
  item.mass = rng.Uniform();
  item.p_OOcm = RandomVector(rng);
  item.P_O.resize(kPoints, 3);
  item.N_O.resize(kPoints, 3);
  for (int i = 0; i < kPoints; ++i) {
    item.P_O.row(i) = RandomVector(rng).transpose();
    item.N_O.row(i) = rng.Direction().transpose();
  }
  const int contexts = static_cast<int>(index % 4);
  for (int c = 0; c < contexts; ++c) {
    ContextRecord context;
    context.kind = c ? "tilted" : "resting";
    context.X_WO = MakeTransform(rng.Rotation(), RandomVector(rng));
    context.phi = VectorX::Random(kPoints);
    for (int i = 0; i < kPoints; ++i) {
      context.phi[i] = rng.Normal();
      context.occluded.push_back(rng.UniformInt(2) == 1);
    }
    item.contexts.push_back(context);
    GraspRecord grasp;
    grasp.context = c;
    for (int f = 0; f < kNumFingers; ++f) {
      grasp.used[f] = f < 4;
      if (!grasp.used[f]) grasp.p_OC[f] = grasp.nhat_O[f] = Vector3::Zero();
      if (!grasp.used[f]) continue;
      grasp.p_OC[f] = RandomVector(rng);
      grasp.nhat_O[f] = rng.Direction();
      grasp.phi[f] = rng.Uniform();
    }
    item.grasps.push_back(grasp);
    LabelRecord label;
    label.context = c;
    label.contacts[c % 2] = PlanningContact{RandomVector(rng), rng.Direction(), rng.Uniform()};
    label.tries = 10;
    for (int& count : label.feasible) count = static_cast<int>(rng.UniformInt(11));
    item.labels.push_back(label);
    TruthRecord truth;
    truth.context = c;
    truth.contacts[1 - c % 2] = PlanningContact{RandomVector(rng), rng.Direction(), rng.Uniform()};
    truth.lifted = rng.UniformInt(2) == 1;
    truth.relief = rng.Uniform();
    truth.room = rng.Uniform();
    item.truths.push_back(truth);
  }
  return item;
}

std::map<std::string, std::string> FilesOf(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    std::ifstream in(entry.path(), std::ios::binary);
    std::stringstream text;
    text << in.rdbuf();
    files[entry.path().filename().string()] = text.str();
  }
  return files;
}

class DatasetTest : public testing::Test {
 protected:
  DatasetTest() {
    fs::remove_all(root_);
    fs::create_directories(root_);
  }
  ~DatasetTest() override { fs::remove_all(root_); }

  const fs::path root_ = fs::path(testing::TempDir()) / "pregrasp_dataset_test" /
                         testing::UnitTest::GetInstance()->current_test_info()->name();
  const std::string description_ = R"({"seed":1})";
};

TEST_F(DatasetTest, ItemsSurviveTheFile) {
  const std::vector<DatasetItem> items = {MakeItem(3), MakeItem(4), MakeItem(6)};
  const TensorFile file = ItemsToTensors(items);
  const std::vector<DatasetItem> read = ItemsFromTensors(file);
  ASSERT_EQ(read.size(), items.size());
  for (std::size_t i = 0; i < items.size(); ++i) {
    const DatasetItem &a = items[i], &b = read[i];
    EXPECT_EQ(a.index, b.index);
    EXPECT_EQ(a.family, b.family);
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.mass, b.mass);
    EXPECT_LT((a.P_O - b.P_O).norm(), 1e-6);
    EXPECT_LT((a.N_O - b.N_O).norm(), 1e-5);
    ASSERT_EQ(a.contexts.size(), b.contexts.size());
    for (std::size_t c = 0; c < a.contexts.size(); ++c) {
      EXPECT_EQ(a.contexts[c].kind, b.contexts[c].kind);
      EXPECT_LT((a.contexts[c].X_WO.matrix() - b.contexts[c].X_WO.matrix()).norm(), 1e-12);
      EXPECT_LT((a.contexts[c].phi - b.contexts[c].phi).norm(), 1e-5);
      EXPECT_EQ(a.contexts[c].occluded, b.contexts[c].occluded);
      EXPECT_EQ(a.grasps[c].context, b.grasps[c].context);
      EXPECT_EQ(a.grasps[c].used, b.grasps[c].used);
      EXPECT_LT((a.grasps[c].p_OC[2] - b.grasps[c].p_OC[2]).norm(), 1e-7);
      EXPECT_EQ(a.labels[c].context, b.labels[c].context);
      EXPECT_EQ(a.labels[c].feasible, b.labels[c].feasible);
      EXPECT_EQ(a.labels[c].Value(), b.labels[c].Value());
      for (int f = 0; f < kNumPlanningFingers; ++f) {
        ASSERT_EQ(a.labels[c].contacts[f].has_value(), b.labels[c].contacts[f].has_value());
        if (!a.labels[c].contacts[f]) continue;
        EXPECT_LT((a.labels[c].contacts[f]->nhat_O - b.labels[c].contacts[f]->nhat_O).norm(), 1e-6);
      }
    }
  }
  EXPECT_EQ(SerializeTensors(ItemsToTensors(read)), SerializeTensors(file));
}

TEST_F(DatasetTest, ALabelIsTheMeanShareOverTheReliefs) {
  LabelRecord label;
  label.tries = 10;
  label.feasible = {0, 0, 5, 10, 10};
  EXPECT_DOUBLE_EQ(label.Value(), 0.5);
}

TEST_F(DatasetTest, ShardsMadeApartMergeToTheSameBytes) {
  constexpr int kItems = 11;
  const ItemFolder whole(root_ / "whole", description_, kItemExtension);
  for (int i = 0; i < kItems; ++i) WriteItem(whole, MakeItem(i));
  std::vector<fs::path> parts;
  for (int s = 0; s < 3; ++s) {
    parts.push_back(root_ / ("part" + std::to_string(s)));
    const ItemFolder part(parts.back(), description_, kItemExtension);
    for (int i = s; i < kItems; i += 3) WriteItem(part, MakeItem(i));
  }
  MergeDataset({root_ / "whole"}, kItems, root_ / "a", 4);
  MergeDataset(parts, kItems, root_ / "b", 4);
  EXPECT_EQ(FilesOf(root_ / "a"), FilesOf(root_ / "b"));
  EXPECT_EQ(FilesOf(root_ / "a").size(), 4U);  // three shards and the index

  const Dataset dataset = ReadDataset(root_ / "a");
  ASSERT_EQ(dataset.items.size(), static_cast<std::size_t>(kItems));
  for (int i = 0; i < kItems; ++i) EXPECT_EQ(dataset.items[i].name, MakeItem(i).name);
  EXPECT_EQ(dataset.hash.size(), 64U);
}

TEST_F(DatasetTest, AFolderKnowsWhatItHasAndRefusesAnotherConfiguration) {
  const ItemFolder folder(root_ / "items", description_, kItemExtension);
  EXPECT_FALSE(folder.Has(2));
  WriteItem(folder, MakeItem(2));
  EXPECT_TRUE(ItemFolder(root_ / "items", description_, kItemExtension).Has(2));
  EXPECT_FALSE(folder.Has(3));
  EXPECT_THROW(ItemFolder(root_ / "items", R"({"seed":2})", kItemExtension), InputError);
  EXPECT_THROW(MergeDataset({root_ / "items"}, 4, root_ / "out"), InputError);  // 0 is missing
}

TEST_F(DatasetTest, AnAlteredDataSetIsRefused) {
  const ItemFolder folder(root_ / "items", description_, kItemExtension);
  for (int i = 0; i < 3; ++i) WriteItem(folder, MakeItem(i));
  MergeDataset({root_ / "items"}, 3, root_ / "data");
  EXPECT_NO_THROW(ReadDataset(root_ / "data"));
  {
    std::fstream shard(root_ / "data" / "shard-0000.safetensors",
                       std::ios::binary | std::ios::in | std::ios::out);
    shard.seekp(-1, std::ios::end);
    shard.put('\7');
  }
  EXPECT_THROW(ReadDataset(root_ / "data"), InputError);
  std::ofstream(root_ / "data" / "index.json") << "{}";
  EXPECT_THROW(ReadDataset(root_ / "data"), InputError);
  EXPECT_THROW(ReadDataset(root_ / "nothing"), InputError);
}

TEST_F(DatasetTest, TablesThatReferToNothingAreRefused) {
  TensorFile file = ItemsToTensors({MakeItem(3)});
  file.tensors["label.context"] = MakeTensor<std::int32_t>({3}, {0, 3, 1});
  EXPECT_THROW(ItemsFromTensors(file), InputError);
  file = ItemsToTensors({MakeItem(3)});
  file.tensors.erase("grasp.used");
  EXPECT_THROW(ItemsFromTensors(file), InputError);
}

}  // namespace
}  // namespace pregrasp
