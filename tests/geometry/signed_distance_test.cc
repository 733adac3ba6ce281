#include "app/geometry/signed_distance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "app/core/rng.h"
#include "app/geometry/mesh_distance.h"
#include "tests/geometry/test_shapes.h"

namespace pregrasp {
namespace {

using testing::At;
using testing::MakeMesh;
using testing::NamedShape;
using testing::ShapesOfEveryKind;

Vector3 RandomPoint(Rng& rng, double reach) {
  return {rng.Uniform(-reach, reach), rng.Uniform(-reach, reach), rng.Uniform(-reach, reach)};
}

TEST(SignedDistanceTest, OfABoxIsExactAtFaceEdgeCornerAndInside) {
  const SignedDistance distance(Box{Vector3(2, 4, 6)});
  EXPECT_DOUBLE_EQ(distance.Calc({2, 0, 0}), 1.0);
  EXPECT_DOUBLE_EQ(distance.Calc({4, -6, 0}), 5.0);
  EXPECT_DOUBLE_EQ(distance.Calc({2, 3, -5}), std::sqrt(1.0 + 1.0 + 4.0));
  EXPECT_DOUBLE_EQ(distance.Calc({0.75, 0, 0}), -0.25);
  EXPECT_DOUBLE_EQ(distance.Calc({0, 0, 0}), -1.0);
  EXPECT_EQ(distance.CalcWithGradient({0, 1.9, 0}).nhat, Vector3(0, 1, 0));
}

TEST(SignedDistanceTest, OfRoundPrimitivesIsExact) {
  const SignedDistance cylinder(Cylinder{1.0, 4.0});
  EXPECT_DOUBLE_EQ(cylinder.Calc({4, 0, 6}), 5.0);
  EXPECT_DOUBLE_EQ(cylinder.Calc({0, 3, 0}), 2.0);
  EXPECT_DOUBLE_EQ(cylinder.Calc({0, 0, -2.5}), 0.5);
  EXPECT_DOUBLE_EQ(cylinder.Calc({0.5, 0, 0}), -0.5);
  const SignedDistance capsule(Capsule{1.0, 4.0});
  EXPECT_DOUBLE_EQ(capsule.Calc({3, 0, 6}), 4.0);
  EXPECT_DOUBLE_EQ(capsule.Calc({0, 0, 1}), -1.0);
  EXPECT_DOUBLE_EQ(SignedDistance(Sphere{2.0}).Calc({0, 3, 4}), 3.0);
}

TEST(SignedDistanceTest, GradientsAreUnitVectorsEvenOnMedialAxesAndSurfaces) {
  for (const NamedShape& named : ShapesOfEveryKind()) {
    const SignedDistance distance(named.shape);
    const TriangleMesh surface = Tessellate(named.shape, 16);
    for (int v = 0; v < surface.V.rows(); ++v) {
      const Vector3 p = surface.V.row(v);
      EXPECT_NEAR(distance.CalcWithGradient(p).nhat.norm(), 1.0, 1e-9) << named.name;
      EXPECT_NEAR(distance.CalcWithGradient({0, 0, p.z()}).nhat.norm(), 1.0, 1e-9) << named.name;
    }
    EXPECT_NEAR(distance.CalcWithGradient(Vector3::Zero()).nhat.norm(), 1.0, 1e-9) << named.name;
  }
}

TEST(SignedDistanceTest, GradientsAgreeWithCentralDifferencesOfEveryKind) {
  constexpr double kStep = 1e-6;
  for (const NamedShape& named : ShapesOfEveryKind()) {
    const SignedDistance distance(named.shape);
    Rng rng(11);
    int kinks = 0;
    constexpr int kCount = 2000;
    for (int i = 0; i < kCount; ++i) {
      const Vector3 p = RandomPoint(rng, 0.12);
      const DistanceSample sample = distance.CalcWithGradient(p);
      EXPECT_NEAR(sample.phi, distance.Calc(p), 1e-15) << named.name;
      Vector3 numeric;
      for (int k = 0; k < 3; ++k) {
        const Vector3 h = kStep * Vector3::Unit(k);
        numeric[k] = (distance.Calc(p + h) - distance.Calc(p - h)) / (2.0 * kStep);
      }
      // Where the difference straddles a medial axis or a seam of two regions it is not the
      // gradient; such points are rare.
      if ((numeric - sample.nhat).norm() > 1e-3) ++kinks;
    }
    EXPECT_LT(kinks, kCount / 100) << named.name;
  }
}

TEST(SignedDistanceTest, OfABoxMeshEqualsThatOfTheBox) {
  const Box box{Vector3(0.3, 0.03, 0.1)};
  const SignedDistance exact(box);
  for (const int times : {0, 3}) {
    const SignedDistance mesh(MakeMesh(testing::Subdivide(Tessellate(box), times)));
    Rng rng(5);
    for (int i = 0; i < 5000; ++i) {
      const Vector3 p = RandomPoint(rng, i % 2 == 0 ? 0.3 : 0.05);
      EXPECT_NEAR(mesh.Calc(p), exact.Calc(p), 1e-12) << p.transpose();
    }
  }
}

TEST(SignedDistanceTest, OfAMeshHasTheSignOfTheWindingNumberNearThinWallsAndSharpEdges) {
  for (const TriangleMesh& mesh :
       {testing::MakeCup(0.04, 0.1, 0.002, 20), testing::MakePlate(24), testing::MakeC(0.03, 0.02),
        testing::MakeBowl(0.08, 0.002, 8, 24), testing::MakeTorus(0.04, 0.01, 20, 10)}) {
    const MeshDistance distance(mesh);
    Rng rng(9);
    for (int i = 0; i < 4000; ++i) {
      const int f = static_cast<int>(rng.UniformInt(static_cast<std::uint32_t>(mesh.F.rows())));
      const Vector3 near = mesh.V.row(mesh.F(f, static_cast<int>(rng.UniformInt(3))));
      const Vector3 p = near + RandomPoint(rng, 0.005);
      const double winding = CalcWindingNumber(mesh, p);
      EXPECT_EQ(distance.Calc(p) < 0.0, winding > 0.5) << p.transpose();
    }
  }
}

TEST(SignedDistanceTest, OfAMeshIsThatOfTheNearestOfAllTriangles) {
  const TriangleMesh mesh = testing::MakeTorus(0.04, 0.015, 12, 8);
  const MeshDistance distance(mesh);
  Rng rng(2);
  for (int i = 0; i < 500; ++i) {
    const Vector3 p = RandomPoint(rng, 0.08);
    double best = 1e9;
    for (int f = 0; f < mesh.F.rows(); ++f) {
      TriangleMesh one;
      one.V = mesh.V;
      one.F = mesh.F.row(f);
      best = std::min(best, MeshDistance(one).FindNearest(p).distance);
    }
    EXPECT_DOUBLE_EQ(distance.FindNearest(p).distance, best);
  }
}

TEST(SignedDistanceTest, OfAMeshSurvivesTrianglesWithoutArea) {
  // A cube whose top edge is split by a vertex in its middle: the two triangles there have no area
  // on one side.
  TriangleMesh mesh = Tessellate(Box{Vector3(2, 2, 2)});
  TriangleMesh split = mesh;
  const int a = mesh.F(0, 0), b = mesh.F(0, 1), c = mesh.F(0, 2);
  split.V.conservativeResize(9, 3);
  split.V.row(8) = 0.5 * (mesh.V.row(a) + mesh.V.row(b));
  split.F.conservativeResize(14, 3);
  split.F.row(0) << 8, b, c;
  split.F.row(12) << a, 8, c;
  split.F.row(13) << a, b, 8;  // flat: closes the T
  ASSERT_TRUE(FindDefects(split).closed());
  const MeshDistance distance(split);
  Rng rng(4);
  for (int i = 0; i < 3000; ++i) {
    const Vector3 p = RandomPoint(rng, 2.0);
    EXPECT_NEAR(distance.Calc(p), CalcDistance(Box{Vector3(2, 2, 2)}, p), 1e-12);
  }
}

TEST(SignedDistanceTest, OfAUnionIsTheSmallestOfItsPartsAlsoWhenNested) {
  Union inner;
  inner.parts.push_back({Sphere{0.02}, At(0.05, 0, 0)});
  inner.parts.push_back({Box{Vector3(0.02, 0.02, 0.02)}, At(0, 0.05, 0)});
  Union whole;
  whole.parts.push_back({inner, At(0.01, 0, 0)});
  whole.parts.push_back({Cylinder{0.01, 0.1}, RigidTransform::Identity()});
  const SignedDistance distance(whole);
  Rng rng(8);
  for (int i = 0; i < 1000; ++i) {
    const Vector3 p = RandomPoint(rng, 0.1);
    const double expected =
        std::min({CalcDistance(Sphere{0.02}, p - Vector3(0.06, 0, 0)),
                  CalcDistance(Box{Vector3(0.02, 0.02, 0.02)}, p - Vector3(0.01, 0.05, 0)),
                  CalcDistance(Cylinder{0.01, 0.1}, p)});
    EXPECT_NEAR(distance.Calc(p), expected, 1e-15);
  }
}

TEST(SignedDistanceTest, ProjectionLiesOnTheOuterSurface) {
  for (const NamedShape& named : ShapesOfEveryKind()) {
    const SignedDistance distance(named.shape);
    Rng rng(3);
    for (int i = 0; i < 1000; ++i) {
      const Vector3 p = RandomPoint(rng, 0.08);
      Vector3 nhat;
      const Vector3 q = distance.Project(p, &nhat);
      EXPECT_NEAR(distance.Calc(q), 0.0, 1e-8) << named.name;
      EXPECT_NEAR(nhat.norm(), 1.0, 1e-9) << named.name;
      const double phi = distance.Calc(p);
      if (phi > 0.0) {
        EXPECT_NEAR((p - q).norm(), phi, 1e-9) << named.name;
        EXPECT_NEAR((p - q).normalized().dot(nhat), 1.0, 1e-6) << named.name;
      }
    }
  }
}

TEST(SignedDistanceTest, BoundsAreTightAroundPlacedShapes) {
  Rng rng(6);
  for (const NamedShape& named : ShapesOfEveryKind()) {
    const RigidTransform X = MakeTransform(rng.Rotation(), rng.Direction());
    const AlignedBox bounds = CalcBounds(named.shape, X);
    const TriangleMesh mesh = Transformed(Tessellate(named.shape, 256), X);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(mesh.V.col(k).minCoeff(), bounds.min()[k], 3e-5) << named.name;
      EXPECT_NEAR(mesh.V.col(k).maxCoeff(), bounds.max()[k], 3e-5) << named.name;
      EXPECT_GE(mesh.V.col(k).minCoeff(), bounds.min()[k] - 1e-12) << named.name;
      EXPECT_LE(mesh.V.col(k).maxCoeff(), bounds.max()[k] + 1e-12) << named.name;
    }
  }
}

TEST(EnvironmentDistanceTest, IsTheSmallestOverAllBodiesButTheObject) {
  Scene scene;
  scene.bodies.resize(4);
  scene.bodies[0].shape = Sphere{1.0};  // the object; must not count
  Rng rng(12);
  const std::vector<NamedShape> shapes = ShapesOfEveryKind();
  const Shape bodies[] = {shapes[0].shape, shapes[4].shape, shapes[6].shape};
  for (int round = 0; round < 5; ++round) {
    std::vector<RigidTransform> X_WB(4, RigidTransform::Identity());
    for (int b = 1; b < 4; ++b) {
      scene.bodies[b].shape = bodies[b - 1];
      X_WB[b] = MakeTransform(rng.Rotation(), 0.15 * rng.Direction());
      scene.bodies[b].X_WB = X_WB[b];
    }
    const EnvironmentDistance environment(scene);
    std::vector<SignedDistance> each;
    for (const Shape& shape : bodies) each.emplace_back(shape);
    for (int i = 0; i < 200; ++i) {
      const Vector3 p = RandomPoint(rng, 0.2);
      double expected = 1e9;
      for (int b = 1; b < 4; ++b) {
        expected = std::min(expected, each[b - 1].Calc(X_WB[b].inverse() * p));
      }
      const DistanceSample at_start = environment.Calc(p), posed = environment.Calc(p, X_WB);
      EXPECT_NEAR(at_start.phi, expected, 1e-12);
      EXPECT_NEAR(posed.phi, expected, 1e-12);
      EXPECT_NEAR((at_start.nhat - posed.nhat).norm(), 0.0, 1e-6);
    }
  }
}

}  // namespace
}  // namespace pregrasp
