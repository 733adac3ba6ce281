#include "app/geometry/sharp_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/geometry/load_shape.h"
#include "app/geometry/tessellate.h"

namespace pregrasp {
namespace {

constexpr double kLeast = kPi / 36.0;

int CountCorners(const std::vector<EdgePoint>& points) {
  return static_cast<int>(std::count_if(points.begin(), points.end(),
                                        [](const EdgePoint& point) { return point.corner(); }));
}

// How far the farthest of `places` is from the nearest of the points.
double FarthestFrom(const std::vector<EdgePoint>& points, const std::vector<Vector3>& places) {
  double farthest = 0.0;
  for (const Vector3& place : places) {
    double nearest = 1e9;
    for (const EdgePoint& point : points) nearest = std::min(nearest, (point.p_B - place).norm());
    farthest = std::max(farthest, nearest);
  }
  return farthest;
}

TEST(SharpEdgesTest, ABoxHasTwelveEdgesAndEightCornersWithTheNormalsOfTheirFaces) {
  const Vector3 size(0.06, 0.04, 0.006);
  const std::vector<EdgePoint> points = FindEdgePoints(Box{size}, 2e-3, kLeast);
  EXPECT_EQ(CountCorners(points), 8);
  EXPECT_EQ(points.size(), 8U + 4 * (29 + 19 + 2));
  for (const EdgePoint& point : points) {
    for (const Vector3& nhat : point.nhats_B) {
      EXPECT_NEAR(nhat.dot(point.p_B), nhat.cwiseAbs().dot(0.5 * size), 1e-12);  // on that face
    }
    EXPECT_NEAR(point.nhats_B[0].dot(point.nhats_B[1]), 0.0, 1e-12);
  }
}

TEST(SharpEdgesTest, AMeshOfTheBoxHasTheSameEdgesAndCornersAndNoneOnItsDiagonals) {
  const Shape box = Box{{0.06, 0.04, 0.02}};
  Mesh mesh;
  mesh.mesh = Tessellate(box);
  const std::vector<EdgePoint> points = FindEdgePoints(mesh, 2e-3, kLeast);
  const std::vector<EdgePoint> expected = FindEdgePoints(box, 2e-3, kLeast);
  EXPECT_EQ(CountCorners(points), 8);
  EXPECT_EQ(points.size(), expected.size());
  std::vector<Vector3> places;
  for (const EdgePoint& point : expected) places.push_back(point.p_B);
  EXPECT_LT(FarthestFrom(points, places), 1e-9);
}

TEST(SharpEdgesTest, RimsAreSampledByTurnAndNothingElseOfACylinder) {
  const std::vector<EdgePoint> points = FindEdgePoints(Cylinder{0.009, 0.14}, 2e-3, kLeast);
  EXPECT_EQ(points.size(), 2U * 72);
  for (const EdgePoint& point : points) {
    EXPECT_NEAR(point.p_B.head<2>().norm(), 0.009, 1e-12);
    EXPECT_NEAR(std::abs(point.p_B.z()), 0.07, 1e-12);
    EXPECT_GT(point.nhats_B[0].dot(point.p_B), 0.0);
    EXPECT_GT(point.nhats_B[1].dot(point.p_B), 0.0);
  }
  EXPECT_TRUE(FindEdgePoints(Sphere{0.02}, 2e-3, kLeast).empty());
  EXPECT_TRUE(FindEdgePoints(Capsule{0.02, 0.1}, 2e-3, kLeast).empty());
}

TEST(SharpEdgesTest, HollowEdgesOfAMeshAreLeftOut) {
  // A prism over an L: of its seven side edges the one in the inner corner is hollow.
  const std::vector<Vector2> outline{{0, 0},       {0.04, 0},    {0.04, 0.02},
                                     {0.02, 0.02}, {0.02, 0.04}, {0, 0.04}};
  Mesh mesh;
  mesh.mesh.V.resize(12, 3);
  for (int i = 0; i < 6; ++i) {
    mesh.mesh.V.row(i) << outline[i].x(), outline[i].y(), 0.0;
    mesh.mesh.V.row(6 + i) << outline[i].x(), outline[i].y(), 0.01;
  }
  mesh.mesh.F.resize(20, 3);
  int row = 0;
  for (int i = 0; i < 6; ++i) {
    const int j = (i + 1) % 6;
    mesh.mesh.F.row(row++) << i, j, 6 + j;
    mesh.mesh.F.row(row++) << i, 6 + j, 6 + i;
  }
  const std::array<std::array<int, 3>, 4> cap{{{0, 1, 3}, {1, 2, 3}, {0, 3, 5}, {3, 4, 5}}};
  for (const auto& [a, b, c] : cap) {
    mesh.mesh.F.row(row++) << a, c, b;
    mesh.mesh.F.row(row++) << 6 + a, 6 + b, 6 + c;
  }
  const std::vector<EdgePoint> points = FindEdgePoints(mesh, 1e-3, kLeast);
  const auto inside = [](const EdgePoint& point) {
    return (point.p_B.head<2>() - Vector2(0.02, 0.02)).norm() < 1e-9 && point.p_B.z() > 1e-4 &&
           point.p_B.z() < 0.0099;
  };
  EXPECT_EQ(std::count_if(points.begin(), points.end(), inside), 0);
  EXPECT_GT(points.size(), 100U);
}

TEST(SharpEdgesTest, PartsOfAUnionBringTheirEdgesInTheFrameOfTheWhole) {
  Union whole;
  whole.parts.push_back({Box{{0.02, 0.02, 0.02}},
                         MakeTransform(RotationFromRpy({0, 0, 0.25 * kPi}), Vector3(0.1, 0, 0))});
  const std::vector<EdgePoint> points = FindEdgePoints(whole, 5e-3, kLeast);
  double farthest = 0.0;
  for (const EdgePoint& point : points) farthest = std::max(farthest, point.p_B.x());
  EXPECT_NEAR(farthest, 0.1 + 0.01 * std::sqrt(2.0), 1e-12);
}

}  // namespace
}  // namespace pregrasp
