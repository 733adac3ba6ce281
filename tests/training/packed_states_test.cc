#include "app/training/packed_states.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "app/core/error.h"
#include "app/core/gzip.h"
#include "tests/training/toy_dataset.h"

namespace pregrasp {
namespace {

double AngleBetween(const Vector3& a, const Vector3& b) {
  return RadToDeg(std::atan2(a.cross(b).norm(), a.dot(b)));
}

TEST(PackedStatesTest, WhatIsUnpackedIsWhatWasPackedToItsPrecision) {
  Dataset packed = MakeToyDataset(3, 6, 100);  // no multiple of 8 points
  for (DatasetItem& item : packed.items) {
    for (ContextRecord& context : item.contexts) context.phi[0] = 1e3;  // no surroundings
    Rng rng(9, RngStream::kTest, static_cast<std::uint64_t>(item.index));
    for (Eigen::Index p = 0; p < item.N_O.rows(); ++p) item.N_O.row(p) = rng.Direction();
  }
  const TensorFile file = PackStates(packed);
  const Dataset unpacked = UnpackStates(ParseTensors(SerializeTensors(file), "packed"));
  EXPECT_EQ(unpacked.description, packed.description);
  ASSERT_EQ(unpacked.items.size(), packed.items.size());
  for (std::size_t i = 0; i < packed.items.size(); ++i) {
    const DatasetItem &a = packed.items[i], &b = unpacked.items[i];
    EXPECT_EQ(b.index, a.index);
    EXPECT_EQ(b.family, a.family);
    EXPECT_EQ(b.name, a.name);
    EXPECT_LT((a.P_O - b.P_O).cwiseAbs().maxCoeff(), 5e-6);
    for (Eigen::Index p = 0; p < a.N_O.rows(); ++p) {
      EXPECT_LT(AngleBetween(a.N_O.row(p), b.N_O.row(p)), 1.0);
    }
    ASSERT_EQ(b.contexts.size(), a.contexts.size());
    for (std::size_t c = 0; c < a.contexts.size(); ++c) {
      EXPECT_EQ(b.contexts[c].kind, a.contexts[c].kind);
      EXPECT_EQ(b.contexts[c].occluded, a.contexts[c].occluded);
      EXPECT_TRUE(b.contexts[c].X_WO.isApprox(a.contexts[c].X_WO, 1e-6));
      for (Eigen::Index p = 0; p < a.contexts[c].phi.size(); ++p) {
        EXPECT_NEAR(b.contexts[c].phi[p], std::clamp(a.contexts[c].phi[p], -0.02, 0.10), 2.5e-4);
      }
    }
    ASSERT_EQ(b.truths.size(), a.truths.size());
    for (std::size_t t = 0; t < a.truths.size(); ++t) {
      EXPECT_EQ(b.truths[t].context, a.truths[t].context);
      EXPECT_EQ(b.truths[t].lifted, a.truths[t].lifted);
      EXPECT_NEAR(b.truths[t].relief, a.truths[t].relief, 0.002);
      EXPECT_NEAR(b.truths[t].room, a.truths[t].room, 0.002);
      for (int f = 0; f < kNumPlanningFingers; ++f) {
        ASSERT_EQ(b.truths[t].contacts[f].has_value(), a.truths[t].contacts[f].has_value());
        if (!a.truths[t].contacts[f]) continue;
        EXPECT_LT((a.truths[t].contacts[f]->p_OC - b.truths[t].contacts[f]->p_OC).norm(), 1e-5);
      }
    }
  }
  // Packing what was unpacked changes nothing any more.
  EXPECT_EQ(UnpackStates(PackStates(unpacked)).items.size(), packed.items.size());
}

TEST(PackedStatesTest, AFileIsReadWhereAFolderIsAsked) {
  const auto path = std::filesystem::path(testing::TempDir()) / "packed_states_test.safetensors";
  WriteTensors(path, PackStates(MakeToyDataset(4, 3, 64)));
  const Dataset dataset = ReadDataset(path);
  EXPECT_EQ(dataset.items.size(), 3U);
  EXPECT_EQ(dataset.hash.size(), 64U);
  std::filesystem::remove(path);
}

TEST(PackedStatesTest, DamageIsSaid) {
  TensorFile file = PackStates(MakeToyDataset(5, 2, 64));
  TensorFile other = file;
  other.metadata["format"] = "pregrasp items 2";
  EXPECT_THROW(UnpackStates(other), InputError);
  other = file;
  other.metadata["points"] = "63";
  EXPECT_THROW(UnpackStates(other), InputError);
  other = file;
  other.metadata["points"] = "many";
  EXPECT_THROW(UnpackStates(other), InputError);
  other = file;
  other.tensors["context.truths"] =
      MakeTensor<std::int32_t>({6}, std::vector<std::int32_t>{-8, 24, 8, 8, 8, 8});
  EXPECT_THROW(UnpackStates(other), InputError);
  other = file;
  other.tensors.erase("truth.bits");
  EXPECT_THROW(UnpackStates(other), InputError);
}

TEST(PackedStatesTest, GzipChangesNeitherContentNorHash) {
  const std::filesystem::path plain =
      std::filesystem::path(testing::TempDir()) / "states.safetensors";
  const std::filesystem::path packed = plain.string() + ".gz";
  const std::string bytes = SerializeTensors(PackStates(MakeToyDataset(3, 4, 64)));
  WriteWholeFile(plain, bytes);
  WriteWholeFile(packed, Deflate(bytes));
  const Dataset a = ReadDataset(plain), b = ReadDataset(packed);
  EXPECT_EQ(a.hash, b.hash);
  EXPECT_EQ(a.items.size(), b.items.size());
  const Dataset both = ReadDatasets({plain, packed});
  EXPECT_EQ(both.items.size(), 2 * a.items.size());
  EXPECT_NE(both.hash, a.hash);
}

}  // namespace
}  // namespace pregrasp
