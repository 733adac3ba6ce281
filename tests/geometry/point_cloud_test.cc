#include "app/geometry/point_cloud.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/geometry/occlusion.h"
#include "app/geometry/signed_distance.h"
#include "tests/geometry/test_shapes.h"

namespace pregrasp {
namespace {

using testing::At;
using testing::NamedShape;

TEST(PointCloudTest, LiesOnTheOuterSurfaceWithItsOutwardNormals) {
  for (const NamedShape& named : testing::ShapesOfEveryKind()) {
    const SignedDistance distance(named.shape);
    const PointCloud cloud = SamplePointCloud(named.shape, 512, Rng(1, RngStream::kObjectCloud));
    ASSERT_EQ(cloud.P.rows(), 512) << named.name;
    for (int i = 0; i < cloud.P.rows(); ++i) {
      const Vector3 p = cloud.P.row(i), nhat = cloud.N.row(i);
      EXPECT_NEAR(distance.Calc(p), 0.0, 1e-12) << named.name;
      EXPECT_NEAR(nhat.norm(), 1.0, 1e-12) << named.name;
      EXPECT_GT(distance.Calc(p + 1e-5 * nhat), 0.9e-5) << named.name;
    }
  }
}

// Distances from each point to the nearest other one.
VectorX NearestOther(const MatrixX3& P) {
  VectorX nearest(P.rows());
  for (int i = 0; i < P.rows(); ++i) {
    VectorX squared = (P.rowwise() - P.row(i)).rowwise().squaredNorm();
    squared[i] = std::numeric_limits<double>::infinity();
    nearest[i] = std::sqrt(squared.minCoeff());
  }
  return nearest;
}

TEST(PointCloudTest, IsEvenlySpacedForManySeeds) {
  // Disc packing: n points on an area A cannot all be farther apart than this.
  const auto densest = [](double area, int n) {
    return std::sqrt(2.0 / std::sqrt(3.0) * area / n);
  };
  for (int seed = 0; seed < 5; ++seed) {
    const int count = 1024;
    const Box ruler{Vector3(0.3, 0.03, 0.003)};
    const double area = CalcArea(Tessellate(ruler));
    const VectorX nearest =
        NearestOther(SamplePointCloud(ruler, count, Rng(seed, RngStream::kObjectCloud)).P);
    EXPECT_GT(nearest.minCoeff(), 0.5 * densest(area, count)) << seed;
    EXPECT_LT(nearest.maxCoeff(), 1.3 * densest(area, count)) << seed;
  }
}

TEST(PointCloudTest, LeavesOutWhatLiesInsideOrFlushBetweenParts) {
  Union whole;  // a box of two flush halves, with a ball sunk into one
  whole.parts.push_back({Box{Vector3(0.1, 0.1, 0.1)}, At(-0.05, 0, 0)});
  whole.parts.push_back({Box{Vector3(0.1, 0.1, 0.1)}, At(0.05, 0, 0)});
  whole.parts.push_back({Sphere{0.03}, At(0.1, 0, 0)});
  const PointCloud cloud = SamplePointCloud(whole, 1024, Rng(2, RngStream::kObjectCloud));
  for (int i = 0; i < cloud.P.rows(); ++i) {
    const Vector3 p = cloud.P.row(i);
    const bool between =
        std::abs(p.x()) < 1e-6 && std::abs(p.y()) < 0.05 - 1e-6 && std::abs(p.z()) < 0.05 - 1e-6;
    EXPECT_FALSE(between) << p.transpose();
    EXPECT_GT(CalcDistance(Sphere{0.03}, p - Vector3(0.1, 0, 0)), -1e-9);
  }
}

TEST(PointCloudTest, DependsOnlyOnTheSeed) {
  const Shape shape = Capsule{0.02, 0.05};
  const PointCloud a = SamplePointCloud(shape, 300, Rng(3, RngStream::kObjectCloud));
  const PointCloud b = SamplePointCloud(shape, 300, Rng(3, RngStream::kObjectCloud));
  const PointCloud c = SamplePointCloud(shape, 300, Rng(4, RngStream::kObjectCloud));
  EXPECT_EQ(a.P, b.P);
  EXPECT_NE(a.P, c.P);
}

Scene TableScene() {
  Scene scene;
  scene.bodies.resize(2);
  scene.bodies[0].shape = Box{Vector3(0.3, 0.03, 0.003)};
  scene.bodies[0].X_WB = At(0, 0, 0.0015);
  scene.bodies[1].shape = Box{Vector3(1, 1, 0.02)};
  scene.bodies[1].X_WB = At(-0.6, 0, -0.01);  // its edge at x = -0.1
  return scene;
}

TEST(OcclusionTest, OfARulerOnATableIsAllButItsTopAndWhatReachesOverTheEdge) {
  const Scene scene = TableScene();
  const PointCloud cloud =
      SamplePointCloud(scene.object().shape, 1024, Rng(1, RngStream::kObjectCloud));
  const double radius = 0.009;
  const std::vector<bool> occluded =
      FindOccluded(cloud, scene.object().X_WB, EnvironmentDistance(scene), radius);
  for (int i = 0; i < cloud.P.rows(); ++i) {
    const Vector3 p = cloud.P.row(i), nhat = cloud.N.row(i);
    if (nhat.z() > 0.5) {  // the sphere's centre is 12 mm above the table
      EXPECT_FALSE(occluded[i]);
    } else if (p.x() < -0.1 - 1e-6) {
      EXPECT_TRUE(occluded[i]);
    } else if (p.x() > -0.1 + radius) {
      EXPECT_FALSE(occluded[i]);
    }
  }
}

TEST(OcclusionTest, EndsWhereASphereJustFits) {
  // A gap between two faces: free as long as it is wider than the sphere, though it touches.
  for (const double gap : {0.0179, 0.018, 0.0181}) {
    Scene scene;
    scene.bodies.resize(2);
    scene.bodies[0].shape = Box{Vector3(0.1, 0.1, 0.1)};
    scene.bodies[1].shape = Box{Vector3(0.1, 0.3, 0.3)};
    scene.bodies[1].X_WB = At(0.1 + gap, 0, 0);
    PointCloud cloud;
    cloud.P = Vector3(0.05, 0.01, 0.02).transpose();
    cloud.N = Vector3::UnitX().transpose();
    const auto occluded =
        FindOccluded(cloud, scene.object().X_WB, EnvironmentDistance(scene), 0.009);
    EXPECT_EQ(occluded[0], gap < 0.018) << gap;
  }
}

}  // namespace
}  // namespace pregrasp
