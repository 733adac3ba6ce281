#include "app/geometry/overlap.h"

#include <gtest/gtest.h>

#include <cmath>

#include "app/core/rng.h"
#include "app/geometry/signed_distance.h"
#include "tests/geometry/test_shapes.h"

namespace pregrasp {
namespace {

using testing::At;
using testing::MakeMesh;
using testing::NamedShape;

// Shape `a` movable, `b` fixed.
Scene PairScene(const Shape& a, const RigidTransform& X_WA, const Shape& b,
                const RigidTransform& X_WB) {
  Scene scene;
  scene.bodies.resize(2);
  scene.bodies[0].shape = a;
  scene.bodies[0].X_WB = X_WA;
  scene.bodies[0].mass_properties = MassProperties{1.0, Vector3::Zero(), Matrix3::Identity()};
  scene.bodies[1].shape = b;
  scene.bodies[1].X_WB = X_WB;
  return scene;
}

double DepthOf(const Scene& scene) {
  const auto overlaps = FindOverlaps(scene);
  return overlaps.empty() ? 0.0 : overlaps[0].depth;
}

// Every kind of shape standing on a table at height `gap`, turned about z.
TEST(FindOverlapsTest, CountsNeitherTouchNorAHairsBreadthButAMillimetre) {
  const Shape box = Box{Vector3(0.5, 0.4, 0.05)};
  const Shape table_mesh = MakeMesh(Tessellate(Box{Vector3(0.5, 0.4, 0.05)}));
  for (const NamedShape& named : testing::ShapesOfEveryKind()) {
    for (const Shape& table : {box, table_mesh}) {
      Rng rng(5);
      for (int i = 0; i < 3; ++i) {
        RigidTransform X =
            MakeTransform(RotationFromRpy({0, 0, rng.Uniform(0, 3)}),
                          Vector3(rng.Uniform(-0.05, 0.05), rng.Uniform(-0.05, 0.05), 0.025));
        const double bottom = CalcBounds(named.shape, X).min().z() - 0.025;
        const RigidTransform X_WT =
            MakeTransform(rng.Rotation(), Vector3(0.1, -0.2, 0.3));  // the whole world turned
        const auto at_gap = [&](double gap) {
          RigidTransform X_TB = X;
          X_TB.translation().z() += gap - bottom;
          return PairScene(named.shape, X_WT * X_TB, table, X_WT);
        };
        EXPECT_EQ(DepthOf(at_gap(1e-3)), 0.0) << named.name;
        EXPECT_EQ(DepthOf(at_gap(0.0)), 0.0) << named.name;
        EXPECT_EQ(DepthOf(at_gap(-2e-5)), 0.0) << named.name;
        EXPECT_NEAR(DepthOf(at_gap(-8e-5)), 8e-5, 2e-6) << named.name;
        EXPECT_NEAR(DepthOf(at_gap(-1e-3)), 1e-3, 2e-6) << named.name;
      }
    }
  }
}

TEST(FindOverlapsTest, FindsEdgesThatCross) {
  // Two long bars on edge, crossing at a right angle, their edges 1 mm into one another.
  const Box bar{Vector3(0.4, 0.02, 0.02)};
  const Matrix3 on_edge = RotationFromRpy({kPi / 4, 0, 0});
  const double height = 0.02 / std::sqrt(2.0);
  for (const double deep : {1e-3, -1e-3}) {
    const RigidTransform X_WA = MakeTransform(on_edge, Vector3(0.113, 0, 2 * height - deep));
    const RigidTransform X_WB =
        MakeTransform(RotationFromRpy({0, 0, kPi / 2}) * on_edge, Vector3(0.171, 0.037, 0));
    const double depth = DepthOf(PairScene(bar, X_WA, bar, X_WB));
    if (deep < 0.0) {
      EXPECT_EQ(depth, 0.0);
    } else {
      EXPECT_NEAR(depth, deep / std::sqrt(2.0), 1e-6);  // to the nearest face
    }
  }
}

TEST(FindOverlapsTest, FindsABodyInsideAnother) {
  const Shape ball = Sphere{0.02};
  const Shape ball_mesh = MakeMesh(Tessellate(ball));
  const Shape box = Box{Vector3(0.2, 0.2, 0.2)};
  const Shape box_mesh = MakeMesh(Tessellate(box));
  for (const Shape& inner : {ball, ball_mesh}) {
    for (const Shape& outer : {box, box_mesh}) {
      EXPECT_GT(DepthOf(PairScene(inner, At(0.01, 0, 0), outer, At(0, 0, 0))), 0.07);
      EXPECT_GT(DepthOf(PairScene(outer, At(0.01, 0, 0), inner, At(0, 0, 0))), 0.07);
    }
  }
}

TEST(FindOverlapsTest, ABallInACupIsFree) {
  const Shape cup = MakeMesh(testing::MakeCup(0.04, 0.1, 0.003, 48));
  EXPECT_EQ(DepthOf(PairScene(Sphere{0.03}, At(0, 0, 0.035), cup, At(0, 0, 0))), 0.0);
  EXPECT_EQ(DepthOf(PairScene(Sphere{0.03}, At(0, 0, 0.033), cup, At(0, 0, 0))), 0.0);
  EXPECT_NEAR(DepthOf(PairScene(Sphere{0.03}, At(0, 0, 0.032), cup, At(0, 0, 0))), 1e-3, 1e-6);
}

TEST(FindOverlapsTest, SaysNothingOfTwoFixedBodiesAndSortsTheOthersByDepth) {
  Scene scene;
  scene.bodies.resize(4);
  const Box box{Vector3(0.1, 0.1, 0.1)};
  for (Body& body : scene.bodies) body.shape = box;
  scene.bodies[0].X_WB = At(0, 0, 0.098);
  scene.bodies[0].mass_properties = MassProperties{1.0, Vector3::Zero(), Matrix3::Identity()};
  scene.bodies[1].X_WB = At(0, 0, 0);
  scene.bodies[2].X_WB = At(0.05, 0, 0);  // overlaps 1, both fixed
  scene.bodies[3].X_WB = At(0, 0.09, 0.15);
  const auto overlaps = FindOverlaps(scene);
  ASSERT_EQ(overlaps.size(), 3U);
  EXPECT_EQ(overlaps[0].body_b, 3);
  EXPECT_NEAR(overlaps[0].depth, 0.01, 1e-6);
  for (const Overlap& overlap : overlaps) EXPECT_EQ(overlap.body_a, 0);
  EXPECT_NEAR(overlaps[2].depth, 0.002, 1e-6);
}

TEST(FindOverlapsTest, RandomPairsAgreeWithSignedDistance) {
  // A ball meets a shape exactly when its centre is nearer than its radius.
  for (const NamedShape& named : testing::ShapesOfEveryKind()) {
    const SignedDistance distance(named.shape);
    Rng rng(7);
    for (int i = 0; i < 40; ++i) {
      const Vector3 centre = 0.07 * rng.Direction();
      const double radius = 0.02, phi = distance.Calc(centre);
      if (std::abs(phi - radius) < 1e-4) continue;
      const bool found = DepthOf(PairScene(Sphere{radius}, At(centre.x(), centre.y(), centre.z()),
                                           named.shape, At(0, 0, 0))) > 0.0;
      EXPECT_EQ(found, phi < radius) << named.name << " " << phi;
    }
  }
}

}  // namespace
}  // namespace pregrasp
