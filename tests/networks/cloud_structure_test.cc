#include "app/networks/cloud_structure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "app/core/rng.h"

namespace pregrasp {
namespace {

MatrixX3 RandomCloud(std::uint64_t seed, int count) {
  Rng rng(seed);
  MatrixX3 P(count, 3);
  for (int i = 0; i < count; ++i) {
    P.row(i) << rng.Uniform(-0.1, 0.1), rng.Uniform(-0.05, 0.05), rng.Uniform(-0.02, 0.02);
  }
  return P;
}

const std::vector<SetLevelConfig> kLevels = {{64, 0.05, 16, {}}, {16, 0.10, 16, {}}};

TEST(CloudStructureTest, CentroidsAreSpreadEvenly) {
  // Farthest-point sampling: no point is farther from the centroids than these are from each other.
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const MatrixX3 P = RandomCloud(seed, 300);
    const SetLevel level = BuildCloudStructure(P, Matrix3::Identity(), kLevels).levels.front();
    double separation = 1.0, cover = 0.0;
    for (int i = 0; i < P.rows(); ++i) {
      double nearest = 1.0;
      for (const int c : level.centroids) nearest = std::min(nearest, (P.row(i) - P.row(c)).norm());
      cover = std::max(cover, nearest);
    }
    for (const int a : level.centroids) {
      for (const int b : level.centroids) {
        if (a != b) separation = std::min(separation, (P.row(a) - P.row(b)).norm());
      }
    }
    EXPECT_LE(cover, separation);
    EXPECT_GT(separation, 0.0);
  }
}

TEST(CloudStructureTest, NeighbourhoodsAreTheNearestPointsWithinTheRadius) {
  const MatrixX3 P = RandomCloud(7, 200);
  const SetLevelConfig config{20, 0.03, 8, {}};
  const SetLevel level = BuildCloudStructure(P, Matrix3::Identity(), {config}).levels.front();
  for (int c = 0; c < config.centroids; ++c) {
    const auto distance = [&](int i) { return (P.row(i) - P.row(level.centroids[c])).norm(); };
    std::vector<int> all(P.rows());
    std::iota(all.begin(), all.end(), 0);
    std::sort(all.begin(), all.end(), [&](int a, int b) { return distance(a) < distance(b); });
    const auto within =
        std::count_if(all.begin(), all.end(), [&](int i) { return distance(i) <= config.radius; });
    const int count = level.begin[c + 1] - level.begin[c];
    ASSERT_EQ(count, std::min<int>(static_cast<int>(within), config.neighbors));
    EXPECT_EQ(level.neighbors[level.begin[c]], level.centroids[c]);
    for (int k = 0; k < count; ++k) EXPECT_EQ(level.neighbors[level.begin[c] + k], all[k]);
  }
}

TEST(CloudStructureTest, TheOrderOfThePointsDoesNotMatter) {
  // A lattice is full of equal distances.
  MatrixX3 P(512, 3);
  for (int i = 0; i < 512; ++i) P.row(i) << 0.01 * (i % 8), 0.01 * (i / 8 % 8), 0.01 * (i / 64);
  std::vector<int> order(512);
  std::iota(order.begin(), order.end(), 0);
  Rng rng(3);
  for (int i = 511; i > 0; --i) std::swap(order[i], order[rng.UniformInt(i + 1)]);
  const CloudStructure a = BuildCloudStructure(P, Matrix3::Identity(), kLevels);
  const CloudStructure b =
      BuildCloudStructure(MatrixX3(P(order, Eigen::all)), Matrix3::Identity(), kLevels);
  for (int c = 0; c < 64; ++c) EXPECT_EQ(a.levels[0].centroids[c], order[b.levels[0].centroids[c]]);
  EXPECT_EQ(a.levels[0].begin, b.levels[0].begin);
  for (std::size_t e = 0; e < a.levels[0].neighbors.size(); ++e) {
    EXPECT_EQ(a.levels[0].neighbors[e], order[b.levels[0].neighbors[e]]);
  }
  EXPECT_EQ(a.levels[1].centroids, b.levels[1].centroids);
  EXPECT_EQ(a.levels[1].neighbors, b.levels[1].neighbors);
}

TEST(CloudStructureTest, CoincidentPointsAreChosenOnlyOnce) {
  const MatrixX3 P = MatrixX3::Zero(70, 3);
  const SetLevel level = BuildCloudStructure(P, Matrix3::Identity(), kLevels).levels.front();
  std::vector<int> chosen = level.centroids;
  std::sort(chosen.begin(), chosen.end());
  EXPECT_EQ(std::unique(chosen.begin(), chosen.end()), chosen.end());
}

TEST(CloudStructureTest, TheUprightFrameIsARotationThatTakesUpToZ) {
  for (std::uint32_t trial = 0; trial < 200; ++trial) {
    Rng rng(1, RngStream::kTest, trial);
    CloudStructure structure;
    structure.R_WO0 = rng.Rotation().toRotationMatrix();
    Vector3 up_O = rng.Direction();
    if (trial == 0) up_O = structure.R_WO0.transpose() * Vector3(0.0, 0.0, -1.0);
    const Matrix3 R = structure.CalcUprightFrame(up_O);
    EXPECT_LT((R * up_O - Vector3::UnitZ()).norm(), 1e-12);
    EXPECT_LT((R * R.transpose() - Matrix3::Identity()).norm(), 1e-12);
    EXPECT_NEAR(R.determinant(), 1.0, 1e-12);
  }
}

TEST(CloudStructureTest, TheUprightFrameIsThatOfTheStartAndMovesNoMoreThanTheObject) {
  Rng rng(2);
  CloudStructure structure;
  structure.R_WO0 = rng.Rotation().toRotationMatrix();
  const auto up_at = [&](double tilt) {
    const Matrix3 R_WO =
        Eigen::AngleAxisd(tilt, Vector3(0.6, 0.8, 0.0)).toRotationMatrix() * structure.R_WO0;
    return Vector3(R_WO.transpose() * Vector3::UnitZ());
  };
  EXPECT_LT((structure.CalcUprightFrame(up_at(0.0)) - structure.R_WO0).norm(), 1e-12);
  for (double tilt = 0.0; tilt < 3.0; tilt += 0.1) {
    // Tilted about a level axis the frame is the object's own orientation.
    const Matrix3 R = structure.CalcUprightFrame(up_at(tilt));
    EXPECT_NEAR(RotationAngle(R, structure.R_WO0), tilt, 1e-9);
    EXPECT_NEAR(RotationAngle(R, structure.CalcUprightFrame(up_at(tilt + 0.01))), 0.01, 1e-9);
  }
}

}  // namespace
}  // namespace pregrasp
