#include "app/grasp/surface_points.h"

#include <gtest/gtest.h>

#include <functional>

#include "app/core/error.h"
#include "app/core/rng.h"
#include "tests/grasp/grasp_scenes.h"

namespace pregrasp {
namespace {

double DistanceToNearest(const SurfacePoints& points, const Vector3& p, const Vector3& nhat) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < points.P.rows(); ++i) {
    if (points.N.row(i).dot(nhat) < 0.95) continue;
    least = std::min(least, (points.P.row(i).transpose() - p).norm());
  }
  return least;
}

TEST(SurfacePointsTest, PointsLieOnTheOuterSurfaceWithItsNormals) {
  Union cross;
  cross.parts.push_back({Box{{0.10, 0.02, 0.02}}, RigidTransform::Identity()});
  cross.parts.push_back({Box{{0.02, 0.10, 0.02}}, RigidTransform::Identity()});
  const std::vector<Shape> shapes{Box{{0.1, 0.03, 0.003}}, Cylinder{0.02, 0.05},
                                  Capsule{0.01, 0.06}, Sphere{0.03}, cross};
  for (const Shape& shape : shapes) {
    const SignedDistance distance(shape);
    const SurfacePoints points = MakeSurfacePoints(shape, distance, {});
    ASSERT_GT(points.P.rows(), 200) << ShapeKind(shape);
    for (int i = 0; i < points.P.rows(); ++i) {
      const Vector3 p = points.P.row(i), nhat = points.N.row(i);
      ASSERT_NEAR(distance.Calc(p), 0.0, 2e-6) << ShapeKind(shape);
      ASSERT_NEAR(nhat.norm(), 1.0, 1e-9);
      ASSERT_NEAR(distance.Calc(p + 1e-4 * nhat), 1e-4, 3e-6) << ShapeKind(shape);
    }
  }
}

TEST(SurfacePointsTest, NoSurfacePointIsFartherThanTheSpacingFromASample) {
  Rng rng(1, RngStream::kTest);
  for (const double thickness : {0.003, 0.04}) {
    const Vector3 size(0.3, 0.03, thickness);
    const Shape shape = Box{size};
    const SurfacePoints points = MakeSurfacePoints(shape, SignedDistance(shape), {});
    for (int i = 0; i < 300; ++i) {
      const int axis = static_cast<int>(rng.UniformInt(3));
      Vector3 p, nhat = Vector3::Unit(axis);
      for (int k = 0; k < 3; ++k) p[k] = 0.5 * size[k] * rng.Uniform(-1.0, 1.0);
      if (rng.Uniform() < 0.5) nhat = -nhat;
      p[axis] = 0.5 * size[axis] * nhat[axis];
      EXPECT_LE(DistanceToNearest(points, p, nhat), points.spacing + 1e-9);
    }
  }
  const Shape round = Cylinder{0.03, 0.1};
  const SurfacePoints points = MakeSurfacePoints(round, SignedDistance(round), {});
  for (int i = 0; i < 300; ++i) {
    const double angle = rng.Uniform(0.0, 2.0 * kPi);
    const Vector3 nhat(std::cos(angle), std::sin(angle), 0.0);
    const Vector3 p = 0.03 * nhat + rng.Uniform(-0.05, 0.05) * Vector3::UnitZ();
    EXPECT_LE(DistanceToNearest(points, p, nhat), 1.05 * points.spacing);
  }
}

TEST(SurfacePointsTest, TheBudgetOfPointsWidensTheSpacing) {
  const Shape shape = Box{{1.0, 1.0, 1.0}};
  const SurfacePoints points = MakeSurfacePoints(shape, SignedDistance(shape), {1e-3, 5000});
  EXPECT_GT(points.spacing, 1e-3);
  EXPECT_LT(points.P.rows(), 7000);
  EXPECT_GT(points.P.rows(), 3000);
  EXPECT_THROW(MakeSurfacePoints(shape, SignedDistance(shape), {0.0, 5000}), InputError);
}

TEST(SurfacePointsTest, AFingertipTouchesAFlatRulerOnlyFromAboveAndUnderneathWhereItHangsOver) {
  const double radius = 0.009;
  const auto touch = [&](const Scene& scene, const Vector3& p, const Vector3& nhat, double slack) {
    return CanTouch(p, nhat, radius, {slack, slack}, SignedDistance(scene.object().shape),
                    EnvironmentDistance(scene), {scene.bodies[0].X_WB, scene.bodies[1].X_WB});
  };
  const Scene flat = RulerScene(-0.01);
  EXPECT_TRUE(touch(flat, {0, 0, 0.0015}, {0, 0, 1}, 0.0));
  EXPECT_FALSE(touch(flat, {0, 0.015, 0.001}, {0, 1, 0}, 0.0));
  EXPECT_FALSE(touch(flat, {0, 0.015, 0.001}, {0, 1, 0}, 2e-3));
  const Scene over = RulerScene(0.06);
  // The edge is at x = 0.09: below the ruler a sphere fits beside it, not nearer than its radius.
  EXPECT_TRUE(touch(over, {0.09 + 0.0091, 0, -0.0015}, {0, 0, -1}, 0.0));
  EXPECT_FALSE(touch(over, {0.09 + 0.0080, 0, -0.0015}, {0, 0, -1}, 0.0));
  EXPECT_TRUE(touch(over, {0.09 + 0.0080, 0, -0.0015}, {0, 0, -1}, 2e-3));
}

TEST(SurfacePointsTest, AnInnerCornerOfTheObjectKeepsFingertipsOut) {
  Union corner;
  corner.parts.push_back({Box{{0.1, 0.1, 0.02}}, RigidTransform::Identity()});
  corner.parts.push_back({Box{{0.02, 0.1, 0.1}}, Shift(0.04, 0, 0.05)});
  Scene scene = MakeScene("corner", corner, 0.2, RigidTransform::Identity());
  scene.bodies.push_back(FixedBox("far", {0.1, 0.1, 0.1}, {0, 0, -1}));
  const SignedDistance object(scene.object().shape);
  const EnvironmentDistance environment(scene);
  const std::vector<RigidTransform> X_WB{scene.bodies[0].X_WB, scene.bodies[1].X_WB};
  const double wall = 0.03;
  EXPECT_TRUE(CanTouch({wall - 0.0091, 0, 0.01}, {0, 0, 1}, 0.009, {}, object, environment, X_WB));
  EXPECT_FALSE(CanTouch({wall - 0.0080, 0, 0.01}, {0, 0, 1}, 0.009, {}, object, environment, X_WB));
}

}  // namespace
}  // namespace pregrasp
