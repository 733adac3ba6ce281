#include "app/geometry/cloud_doubts.h"

#include <gtest/gtest.h>

#include "app/core/rng.h"
#include "app/geometry/point_cloud.h"
#include "tests/geometry/test_shapes.h"

namespace pregrasp {
namespace {

// The points of a cloud that `keep` is true for.
template <typename Keep>
MatrixX3 Where(const MatrixX3& P, const Keep& keep) {
  std::vector<int> rows;
  for (int i = 0; i < P.rows(); ++i) {
    if (keep(Vector3(P.row(i)))) rows.push_back(i);
  }
  return TakeRows(P, rows);
}

MatrixX3 Sample(const Shape& shape, int count) { return SamplePointCloud(shape, count, Rng(3)).P; }

// A grid of points in the plane at height z, with a little noise.
MatrixX3 Patch(double half, double step, double z) {
  Rng rng(5);
  std::vector<Vector3> points;
  for (double x = -half; x <= half; x += step) {
    for (double y = -half; y <= half; y += step) {
      points.emplace_back(x, y, z + 0.1 * step * rng.Normal());
    }
  }
  MatrixX3 P(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) P.row(static_cast<Eigen::Index>(i)) = points[i];
  return P;
}

TEST(CloudDoubtsTest, AClosedSurfaceGivesNone) {
  const std::vector<std::pair<std::string, Shape>> shapes = {
      {"ball", Sphere{0.04}},
      {"box", Box{Vector3(0.12, 0.05, 0.03)}},
      {"plate", Box{Vector3(0.2, 0.15, 0.006)}},
      {"can", Cylinder{0.03, 0.1}},
      {"knob on a slab", Union{{{Box{Vector3(0.1, 0.1, 0.02)}},
                                {Box{Vector3(0.02, 0.02, 0.06)}, testing::At(0, 0, 0.04)}}}},
      {"torus", testing::MakeMesh(testing::MakeTorus(0.04, 0.012, 64, 32))}};
  for (const auto& [name, shape] : shapes) {
    const CloudDoubts doubts = FindCloudDoubts(Sample(shape, 3000));
    EXPECT_FALSE(doubts.has_rim()) << name << ", " << doubts.rim_points;
    EXPECT_EQ(doubts.sheet_share, 0.0) << name;
  }
}

TEST(CloudDoubtsTest, PointsInOnePlaceCountOnce) {
  const MatrixX3 ball = Sample(Sphere{0.04}, 2000);
  MatrixX3 P(ball.rows() + 600, 3);
  P << ball, MatrixX3::Constant(600, 3, 0.01);
  EXPECT_FALSE(FindCloudDoubts(P).has_rim());
  EXPECT_FALSE(FindCloudDoubts(MatrixX3(MatrixX3::Constant(600, 3, 0.01))).has_rim());
}

TEST(CloudDoubtsTest, PointsOfSomeSidesEndAlongARim) {
  const MatrixX3 box = Sample(Box{Vector3(0.12, 0.05, 0.06)}, 3000);
  const MatrixX3 no_bottom = Where(box, [](const Vector3& p) { return p.z() > -0.0299; });
  const MatrixX3 one_side =
      Where(box, [](const Vector3& p) { return p.y() > 0.0249 || p.z() > 0.0299; });
  const MatrixX3 half_ball =
      Where(Sample(Sphere{0.05}, 3000), [](const Vector3& p) { return p.x() > 0.0; });
  for (const MatrixX3& P : {no_bottom, one_side, half_ball}) {
    const CloudDoubts doubts = FindCloudDoubts(P);
    EXPECT_TRUE(doubts.has_rim()) << doubts.rim_points;
    EXPECT_EQ(doubts.sheet_share, 0.0);
  }
  EXPECT_LT(FindCloudDoubts(no_bottom).p_rim.z(), -0.025);
  EXPECT_NEAR(FindCloudDoubts(half_ball).p_rim.x(), 0.0, 0.005);
}

TEST(CloudDoubtsTest, ATableUnderTheObjectIsASheetThatReachesBeyondIt) {
  const MatrixX3 can = Sample(Cylinder{0.03, 0.1}, 2500);
  const MatrixX3 table = Patch(0.12, 0.003, -0.05);
  MatrixX3 both(can.rows() + table.rows(), 3);
  both << can, table;
  const double share = static_cast<double>(table.rows()) / static_cast<double>(both.rows());
  EXPECT_NEAR(FindCloudDoubts(both).sheet_share, share, 0.1);
}

}  // namespace
}  // namespace pregrasp
