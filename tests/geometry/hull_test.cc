#include "app/geometry/hull.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "app/core/error.h"
#include "app/core/rng.h"
#include "app/geometry/mass_properties.h"
#include "app/geometry/signed_distance.h"
#include "tests/geometry/test_shapes.h"

namespace pregrasp {
namespace {

using testing::At;
using testing::MakeMesh;

// How far a mesh's vertices lie outside the planes of its own faces [m].
double CalcNonconvexity(const TriangleMesh& mesh) {
  double worst = 0.0;
  for (int f = 0; f < mesh.F.rows(); ++f) {
    const Vector3 a = mesh.V.row(mesh.F(f, 0)), b = mesh.V.row(mesh.F(f, 1)),
                  c = mesh.V.row(mesh.F(f, 2));
    const Vector3 nhat = (b - a).cross(c - a).normalized();
    worst = std::max(worst, (mesh.V * nhat).maxCoeff() - nhat.dot(a));
  }
  return worst;
}

TEST(ConvexHullTest, OfASubdividedBoxIsTheBox) {
  const TriangleMesh box = testing::Subdivide(Tessellate(Box{Vector3(0.3, 0.03, 0.003)}), 3);
  const TriangleMesh hull = CalcConvexHull(box.V);
  EXPECT_EQ(hull.V.rows(), 8);
  EXPECT_EQ(hull.F.rows(), 12);
  EXPECT_NEAR(CalcVolume(hull), 0.3 * 0.03 * 0.003, 1e-18);
}

TEST(ConvexHullTest, IsClosedOutwardConvexAndHoldsAllPoints) {
  for (int seed = 0; seed < 20; ++seed) {
    Rng rng(seed);
    MatrixX3 P(300, 3);
    const Vector3 stretch(rng.Uniform(0.01, 1), rng.Uniform(0.01, 1), rng.Uniform(0.01, 1));
    const RigidTransform X = MakeTransform(rng.Rotation(), 5.0 * rng.Direction());
    for (int i = 0; i < P.rows(); ++i) {
      const Vector3 p(rng.Normal(), rng.Normal(), rng.Normal());
      P.row(i) = (X * p.cwiseProduct(stretch)).transpose();
    }
    const TriangleMesh hull = CalcConvexHull(P);
    EXPECT_TRUE(FindDefects(hull).closed());
    EXPECT_EQ(CalcEulerNumber(hull), 2);
    EXPECT_GT(CalcVolume(hull), 0.0);
    EXPECT_LT(CalcNonconvexity(hull), 1e-12);
    const SignedDistance distance(MakeMesh(hull));
    for (int i = 0; i < P.rows(); ++i) EXPECT_LT(distance.Calc(P.row(i)), 1e-12);
  }
}

TEST(ConvexHullTest, RefusesPointsWithoutVolume) {
  MatrixX3 P = Tessellate(Box{Vector3(1, 1, 1)}).V;
  P.col(1).setConstant(0.3);
  EXPECT_THROW(CalcConvexHull(P), InputError);
  EXPECT_THROW(CalcConvexHull(P.topRows(3)), InputError);
  P = Tessellate(Box{Vector3(1, 1, 1)}).V;
  P(2, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(CalcConvexHull(P), InputError);
  EXPECT_THROW(CalcConvexHull(MatrixX3::Zero(9, 3)), InputError);
}

TEST(ReducedHullTest, LeavesOutNoMoreThanTheToleranceAndKeepsFlatFaces) {
  const TriangleMesh can = Tessellate(Cylinder{0.04, 0.1}, 200);
  const TriangleMesh hull = CalcReducedHull(can.V, 1e-4, 1000);
  EXPECT_LT(hull.V.rows(), 150);
  const SignedDistance distance(MakeMesh(hull));
  for (int v = 0; v < can.V.rows(); ++v) EXPECT_LT(distance.Calc(can.V.row(v)), 1.0001e-4);
  EXPECT_EQ(hull.V.col(2).minCoeff(), -0.05);
  EXPECT_EQ(hull.V.col(2).maxCoeff(), 0.05);
  EXPECT_LE(CalcReducedHull(can.V, 1e-9, 40).V.rows(), 40);
}

TEST(DecomposeConvexTest, LeavesPrimitivesAsTheyAreAndComposesPosesOfNestedUnions) {
  Union inner;
  inner.parts.push_back({Capsule{0.01, 0.05}, At(0, 0, 1)});
  Union whole;
  whole.parts.push_back({inner, MakeTransform(RotationFromRpy({kPi / 2, 0, 0}), {1, 0, 0})});
  whole.parts.push_back({Sphere{0.02}, At(0, 2, 0)});
  const auto pieces = DecomposeConvex(whole);
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_TRUE(std::holds_alternative<Capsule>(pieces[0].shape));
  EXPECT_LT((pieces[0].X_BP.translation() - Vector3(1, -1, 0)).norm(), 1e-15);
  EXPECT_LT((pieces[0].X_BP.linear().col(2) - Vector3(0, -1, 0)).norm(), 1e-15);
  EXPECT_TRUE(std::holds_alternative<Sphere>(pieces[1].shape));
  EXPECT_LT(CalcProtrusion(whole, pieces), 1e-14);
}

TEST(DecomposeConvexTest, AConvexMeshIsOnePiece) {
  const Shape shape = MakeMesh(testing::Subdivide(Tessellate(Box{Vector3(0.1, 0.2, 0.05)}), 3));
  const auto pieces = DecomposeConvex(shape);
  ASSERT_EQ(pieces.size(), 1U);
  EXPECT_EQ(std::get<Mesh>(pieces[0].shape).mesh.F.rows(), 12);
}

TEST(DecomposeConvexTest, ACShapeIsThreeExactBoxes) {
  const Shape shape = MakeMesh(testing::MakeC(0.03, 0.02));
  const auto pieces = DecomposeConvex(shape);
  ASSERT_EQ(pieces.size(), 3U);
  EXPECT_LT(CalcProtrusion(shape, pieces), 1e-9);
  double volume = 0.0;
  for (const ConvexPiece& piece : pieces) volume += CalcVolume(piece.shape);
  EXPECT_NEAR(volume, CalcVolume(shape), 1e-9 * volume);
}

struct Hollow {
  std::string name;
  TriangleMesh mesh;
  double protrusion;           // allowed [m]
  std::vector<Vector3> empty;  // points in the cavity
  double radius;               // of balls there that must stay free
};

std::vector<Hollow> HollowShapes() {
  return {
      {"cup", testing::MakeCup(0.04, 0.1, 0.003, 48), 0.001, {{0, 0, 0.05}, {0, 0, 0.09}}, 0.034},
      {"bowl", testing::MakeBowl(0.08, 0.003, 16, 48), 0.0022, {{0, 0, -0.01}}, 0.060},
      {"plate",
       testing::MakePlate(48),
       0.001,
       {{0, 0, 0.024}, {0.11, 0, 0.030}, {0, 0.12, 0.002}},
       0.006},
      {"torus", testing::MakeTorus(0.04, 0.01, 48, 24), 0.001, {{0, 0, 0}}, 0.027},
      {"C", testing::MakeC(0.03, 0.02), 1e-9, {{0.01, 0, 0}}, 0.0149},
      {"container",
       testing::Revolve({{0, 0},
                         {0.06, 0},
                         {0.075, 0.07},
                         {0.082, 0.07},
                         {0.082, 0.073},
                         {0.073, 0.073},
                         {0.058, 0.003},
                         {0, 0.003}},
                        48),
       0.001,
       {{0, 0, 0.06}},
       0.050},
  };
}

TEST(DecomposeConvexTest, ALidIsItsDiscAndItsPlugExactly) {
  const Shape shape = MakeMesh(testing::Revolve(
      {{0, -0.006}, {0.0415, -0.006}, {0.042, 0}, {0.054, 0}, {0.054, 0.003}, {0, 0.003}}, 48));
  const auto pieces = DecomposeConvex(shape);
  EXPECT_EQ(pieces.size(), 2U);
  EXPECT_LT(CalcProtrusion(shape, pieces), 1e-9);
}

TEST(DecomposeConvexTest, PiecesAreConvexCoverTheShapeAndLeaveCavitiesOpen) {
  for (const Hollow& hollow : HollowShapes()) {
    const Shape shape = MakeMesh(hollow.mesh);
    const DecomposeConfig config;
    const auto pieces = DecomposeConvex(shape, config);
    EXPECT_GT(pieces.size(), 1U) << hollow.name;
    EXPECT_LE(static_cast<int>(pieces.size()), config.max_pieces) << hollow.name;
    EXPECT_LT(CalcProtrusion(shape, pieces), hollow.protrusion) << hollow.name;
    std::vector<SignedDistance> distances;
    for (const ConvexPiece& piece : pieces) {
      const TriangleMesh& hull = std::get<Mesh>(piece.shape).mesh;
      EXPECT_TRUE(FindDefects(hull).closed()) << hollow.name;
      EXPECT_LT(CalcNonconvexity(hull), 1e-9) << hollow.name;
      distances.emplace_back(piece.shape);
    }
    const auto nearest = [&](const Vector3& p) {
      double best = std::numeric_limits<double>::infinity();
      for (const SignedDistance& distance : distances) {
        if (distance.bounds().exteriorDistance(p) < best) best = std::min(best, distance.Calc(p));
      }
      return best;
    };
    for (const Vector3& p : hollow.empty) {
      EXPECT_GT(nearest(p), hollow.radius) << hollow.name << " " << p.transpose();
    }
    const SignedDistance truth(shape);
    Rng rng(1);
    int inside = 0;
    for (int i = 0; i < 8000; ++i) {
      const Vector3 p = truth.bounds().min() + Vector3(rng.Uniform(), rng.Uniform(), rng.Uniform())
                                                   .cwiseProduct(Vector3(truth.bounds().sizes()));
      if (truth.Calc(p) > 0.0) continue;
      ++inside;
      EXPECT_LT(nearest(p), 2.0 * config.tolerance) << hollow.name << " " << p.transpose();
    }
    EXPECT_GT(inside, 50) << hollow.name;
  }
}

TEST(DecomposeConvexTest, IsTheSameEachTime) {
  const Shape shape = MakeMesh(testing::MakeCup(0.04, 0.1, 0.003, 24));
  DecomposeConfig other;  // another in name, so that the second answer is not the first one kept
  other.tolerance = std::nextafter(other.tolerance, 1.0);
  const auto first = DecomposeConvex(shape), second = DecomposeConvex(shape, other);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(std::get<Mesh>(first[i].shape).mesh.V, std::get<Mesh>(second[i].shape).mesh.V);
  }
}

TEST(DecomposeConvexTest, MorePiecesKeepACavityMoreOpen) {
  const Shape shape = MakeMesh(testing::MakeCup(0.04, 0.1, 0.003, 48));
  double last = 1.0;
  for (const int pieces : {6, 12, 24}) {
    DecomposeConfig config;
    config.max_pieces = pieces;
    const double protrusion = CalcProtrusion(shape, DecomposeConvex(shape, config));
    EXPECT_LT(protrusion, 0.75 * last) << pieces;
    last = protrusion;
  }
}

}  // namespace
}  // namespace pregrasp
