#include "app/geometry/contact_faces.h"

#include <gtest/gtest.h>

#include <limits>

#include "app/geometry/hull.h"
#include "app/geometry/signed_distance.h"
#include "tests/geometry/test_shapes.h"

namespace pregrasp {
namespace {

using testing::At;
using testing::MakeMesh;

Vector3 RandomPoint(Rng& rng, const Vector3& reach) {
  return {reach.x() * rng.Uniform(-1, 1), reach.y() * rng.Uniform(-1, 1),
          reach.z() * rng.Uniform(-1, 1)};
}

TEST(ContactFacesTest, AContactLiesOnTheSurfaceWithTheNormalOfItsFace) {
  for (const testing::NamedShape& named : testing::ShapesOfEveryKind()) {
    const SignedDistance distance(named.shape);
    Rng rng(5);
    for (int i = 0; i < 2000; ++i) {
      const FacePoint face = distance.ProjectToFace(RandomPoint(rng, Vector3::Constant(0.08)));
      ASSERT_NEAR(distance.Calc(face.p_B), 0.0, 1e-8) << named.name;
      ASSERT_NEAR(face.nhat_B.norm(), 1.0, 1e-9) << named.name;
      // The surface lies across the normal: straight out the distance grows by as much, straight in
      // it shrinks by that or, beside an edge that is not sharp, by less.
      const double out = 5e-5;
      ASSERT_NEAR(distance.Calc(face.p_B + out * face.nhat_B), out, 1e-6) << named.name;
      ASSERT_NEAR(distance.Calc(face.p_B - out * face.nhat_B), -out, 0.3 * out) << named.name;
    }
  }
}

TEST(ContactFacesTest, OnABoxItIsTheNearestPointHalfAMillimetreInsideAllEdges) {
  const Box box{{0.05, 0.02, 0.001}};  // a quarter of 1 mm on the narrow sides
  const Vector3 inset(0.5e-3, 0.5e-3, 0.25e-3);
  Rng rng(1);
  for (int i = 0; i < 2000; ++i) {
    const Vector3 p = RandomPoint(rng, {0.03, 0.015, 0.003});
    const FacePoint face = ProjectToFace(box, p);
    int axis = 0;
    face.nhat_B.cwiseAbs().maxCoeff(&axis);
    for (int k = 0; k < 3; ++k) {
      if (k == axis) continue;
      EXPECT_LE(std::abs(face.p_B[k]), 0.5 * box.size[k] - inset[k] + 1e-12);
    }
    // No other such point is nearer.
    for (int trial = 0; trial < 30; ++trial) {
      const int other = static_cast<int>(rng.UniformInt(3));
      Vector3 q;
      for (int k = 0; k < 3; ++k) q[k] = (0.5 * box.size[k] - inset[k]) * rng.Uniform(-1, 1);
      q[other] = rng.Uniform() < 0.5 ? 0.5 * box.size[other] : -0.5 * box.size[other];
      EXPECT_GE((q - p).norm(), (face.p_B - p).norm() - 1e-12);
    }
  }
}

TEST(ContactFacesTest, NoNormalIsBetweenTwoFacesOfACylinder) {
  const Cylinder cylinder{0.02, 0.001};
  Rng rng(2);
  int sides = 0, ends = 0;
  for (int i = 0; i < 2000; ++i) {
    const FacePoint face = ProjectToFace(cylinder, RandomPoint(rng, {0.03, 0.03, 0.004}));
    if (std::abs(face.nhat_B.z()) > 0.5) {
      ++ends;
      EXPECT_EQ(std::abs(face.nhat_B.z()), 1.0);
      EXPECT_LE(face.p_B.head<2>().norm(), 0.02 - 0.5e-3 + 1e-12);
    } else {
      ++sides;
      EXPECT_EQ(face.nhat_B.z(), 0.0);
      EXPECT_NEAR(face.p_B.head<2>().norm(), 0.02, 1e-12);
      EXPECT_LE(std::abs(face.p_B.z()), 0.5e-3 - 0.25e-3 + 1e-12);
    }
  }
  EXPECT_GT(sides, 100);
  EXPECT_GT(ends, 100);
}

TEST(ContactFacesTest, AMeshOfABoxHasTheContactsOfTheBox) {
  const Box box{{0.04, 0.012, 0.001}};
  const RigidTransform X = MakeTransform(RotationFromRpy({0.4, 1.1, -0.3}), {0.01, 0.02, -0.03});
  for (const int fine : {0, 3, 5}) {
    const SignedDistance mesh(MakeMesh(Transformed(testing::Subdivide(Tessellate(box), fine), X)));
    Rng rng(3);
    for (int i = 0; i < 3000; ++i) {
      const Vector3 p = RandomPoint(rng, {0.03, 0.01, 0.003});
      const FacePoint expected = ProjectToFace(box, p);
      const FacePoint face = mesh.ProjectToFace(X * p);
      // Not always the nearest contact, but hardly farther.
      EXPECT_GE((face.p_B - X * p).norm(), (expected.p_B - p).norm() - 1e-6) << fine;
      EXPECT_LE((face.p_B - X * p).norm(), (expected.p_B - p).norm() + 2e-4) << fine;
      const FacePoint again = ProjectToFace(box, X.inverse() * face.p_B);
      EXPECT_NEAR((again.p_B - X.inverse() * face.p_B).norm(), 0.0, 2e-7) << fine;
      EXPECT_NEAR(face.nhat_B.dot(X.linear() * again.nhat_B), 1.0, 1e-9) << fine;
    }
  }
}

// A point of a triangle, by what the definition asks: at every side half a millimetre, or a quarter
// of the triangle's width at the point between that side and one that faces it.
void ExpectInsideTriangle(const std::array<Vector3, 3>& t, const Vector3& p) {
  const Vector3 n = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
  for (int i = 0; i < 3; ++i) {
    const Vector3 inward = n.cross(t[(i + 1) % 3] - t[i]).normalized();
    const double distance = inward.dot(p - t[i]);
    double beyond = std::numeric_limits<double>::infinity();
    for (int k = 1; k < 3; ++k) {  // along `inward`, to sides that face this one
      const Vector3& a = t[(i + k) % 3];
      const Vector3 side = n.cross(t[(i + k + 1) % 3] - a).normalized();
      if (side.dot(inward) < -0.7) beyond = std::min(beyond, side.dot(p - a) / -side.dot(inward));
    }
    EXPECT_GE(distance, CalcEdgeInset(distance + beyond) - 1e-6);
  }
}

TEST(ContactFacesTest, OnAnyConvexPolyhedronItIsInsideEverySharpEdge) {
  Rng rng(4);
  int checked = 0;
  for (int shape = 0; shape < 20; ++shape) {
    MatrixX3 P(4 + 2 * (shape % 3), 3);  // few corners: large, small, flat and needle-like faces
    for (int i = 0; i < P.rows(); ++i) P.row(i) = RandomPoint(rng, {0.02, 0.01, 0.002}).transpose();
    const TriangleMesh mesh = CalcConvexHull(P);
    const MeshDistance nearest(mesh);
    const SignedDistance distance(MakeMesh(mesh));
    const auto neighbours = FindNeighbours(mesh);
    const auto normal = [&](int f) {
      const Vector3 a = mesh.V.row(mesh.F(f, 0));
      return Vector3((Vector3(mesh.V.row(mesh.F(f, 1))) - a)
                         .cross(Vector3(mesh.V.row(mesh.F(f, 2))) - a)
                         .normalized());
    };
    for (int i = 0; i < 500; ++i) {
      const FacePoint face = distance.ProjectToFace(RandomPoint(rng, {0.025, 0.015, 0.006}));
      const int f = nearest.FindNearest(face.p_B).triangle;
      bool alone = true;  // a face of one triangle
      for (int k = 0; k < 3; ++k) {
        alone = alone && normal(f).dot(normal(neighbours[f][k])) < std::cos(kSharpAngle) - 1e-6;
      }
      if (!alone) continue;
      ++checked;
      EXPECT_NEAR(face.nhat_B.dot(normal(f)), 1.0, 1e-9);
      ExpectInsideTriangle({Vector3(mesh.V.row(mesh.F(f, 0))), Vector3(mesh.V.row(mesh.F(f, 1))),
                            Vector3(mesh.V.row(mesh.F(f, 2)))},
                           face.p_B);
    }
  }
  EXPECT_GT(checked, 2000);
}

// How near the contacts of a prism come to its upright edges.
double LeastDistanceToCorners(int sides) {
  const double radius = 0.03;
  const TriangleMesh mesh =
      testing::Revolve({{0, -0.02}, {radius, -0.02}, {radius, 0.02}, {0, 0.02}}, sides);
  const SignedDistance distance(MakeMesh(mesh));
  Rng rng(6);
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 20000; ++i) {
    const Vector3 p = distance.ProjectToFace(RandomPoint(rng, {0.04, 0.04, 0.01})).p_B;
    for (int s = 0; s < sides; ++s) {
      const double angle = 2.0 * kPi * s / sides;
      const Vector2 corner(radius * std::cos(angle), radius * std::sin(angle));
      if (std::abs(p.z()) < 0.019) least = std::min(least, (p.head<2>() - corner).norm());
    }
  }
  return least;
}

TEST(ContactFacesTest, AnEdgeIsSharpAboveThirtyDegrees) {
  EXPECT_GE(LeastDistanceToCorners(11), 0.5e-3 - 1e-9);  // 32.7 degrees
  EXPECT_LT(LeastDistanceToCorners(12), 0.1e-3);         // 30
  EXPECT_LT(LeastDistanceToCorners(13), 0.1e-3);         // 27.7
}

TEST(ContactFacesTest, HollowEdgesAreNoLimit) {
  const double a = 0.01;
  const SignedDistance distance(MakeMesh(testing::MakeC(a, 0.02)));
  Rng rng(7);
  double to_hollow = 1.0, to_convex = 1.0;
  for (int i = 0; i < 20000; ++i) {
    const FacePoint face = distance.ProjectToFace(RandomPoint(rng, {0.012, 0.012, 0.008}));
    if (std::abs(face.nhat_B.z()) > 0.5) continue;
    for (const double y : {-0.5 * a, 0.5 * a}) {
      to_hollow = std::min(to_hollow, (face.p_B.head<2>() - Vector2(-0.5 * a, y)).norm());
      for (const double corner : {y, 2.0 * y}) {
        to_convex = std::min(to_convex, (face.p_B.head<2>() - Vector2(a, corner)).norm());
      }
    }
  }
  EXPECT_LT(to_hollow, 0.1e-3);
  EXPECT_GE(to_convex, 0.5e-3 - 1e-9);
}

TEST(ContactFacesTest, OnAUnionItIsOnTheOuterSurfaceAlsoFromWithinSeveralParts) {
  Union whole;
  whole.parts.push_back({Box{{0.10, 0.02, 0.02}}, RigidTransform::Identity()});
  whole.parts.push_back({Box{{0.02, 0.10, 0.02}}, RigidTransform::Identity()});
  whole.parts.push_back({Box{{0.10, 0.02, 0.02}}, At(0.1, 0, 0)});  // flush with the first
  const SignedDistance distance(whole);
  Rng rng(8);
  for (int i = 0; i < 5000; ++i) {
    const Vector3 p =
        RandomPoint(rng, i % 2 ? Vector3(0.16, 0.06, 0.012) : Vector3(0.01, 0.01, 0.01));
    const FacePoint face = distance.ProjectToFace(p);
    ASSERT_NEAR(distance.Calc(face.p_B), 0.0, 1e-9);
    EXPECT_GT(distance.Calc(face.p_B + 1e-4 * face.nhat_B), 0.4e-4);
    EXPECT_LT((face.p_B - p).norm(), std::abs(distance.Calc(p)) + 0.025);
    EXPECT_EQ(distance.ProjectToFace(p).p_B, face.p_B);
  }
}

}  // namespace
}  // namespace pregrasp
