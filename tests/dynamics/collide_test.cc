// Contact between pairs of convex pieces, against the definition: the direction of largest
// separation, found by brute force.
#include "app/dynamics/collide.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "app/core/rng.h"
#include "app/dynamics/gjk.h"
#include "app/dynamics/support.h"
#include "app/geometry/signed_distance.h"
#include "tests/dynamics/scenes.h"

namespace pregrasp {
namespace {

Shape MakeRandomPiece(Rng& rng, int kind) {
  const auto size = [&rng](double low, double high) { return rng.Uniform(low, high); };
  switch (kind) {
    case 0:
      return Box{Vector3(size(0.02, 0.15), size(0.02, 0.15), size(0.002, 0.1))};
    case 1:
      return Cylinder{size(0.01, 0.06), size(0.003, 0.15)};
    case 2:
      return Capsule{size(0.01, 0.03), size(0.02, 0.1)};
    case 3:
      return Sphere{size(0.01, 0.05)};
    default:
      return MakeRandomHull(rng, 14, Vector3(size(0.02, 0.08), size(0.02, 0.08), size(0.02, 0.08)));
  }
}

// The largest separation over all directions: the best of many random ones, then climbed from.
double FindSeparation(const PlacedConvex& a, const PlacedConvex& b, Rng& rng) {
  Vector3 best = Vector3::UnitZ();
  double separation = CalcSeparation(a, b, best);
  const auto try_direction = [&](const Vector3& nhat) {
    const double s = CalcSeparation(a, b, nhat);
    if (s <= separation) return false;
    separation = s;
    best = nhat;
    return true;
  };
  for (int i = 0; i < 2000; ++i) try_direction(rng.Direction());
  for (double step = 0.05; step > 1e-8;) {
    bool improved = false;
    for (int i = 0; i < 12; ++i) {
      improved |= try_direction((best + step * rng.Direction()).normalized());
    }
    if (!improved) step *= 0.7;
  }
  return separation;
}

// A pair of pieces whose gap along some direction is within [low, high]. Seeds 0 to 24 are all
// pairs of kinds, and so on.
struct RandomPair {
  Shape shape_a, shape_b;
  std::vector<Convex> pieces_a, pieces_b;
  PlacedConvex a, b;
  std::string what;

  RandomPair(int seed, Rng& rng, double low, double high)
      : shape_a(MakeRandomPiece(rng, seed % 5)), shape_b(MakeRandomPiece(rng, seed / 5 % 5)) {
    what = std::string(ShapeKind(shape_a)) + " and " + ShapeKind(shape_b) + ", seed " +
           std::to_string(seed);
    pieces_a = BuildConvexPieces(shape_a);
    pieces_b = BuildConvexPieces(shape_b);
    a.convex = pieces_a.data();
    b.convex = pieces_b.data();
    a.R_WP = rng.Rotation().toRotationMatrix();
    b.R_WP = rng.Rotation().toRotationMatrix();
    const Vector3 d = rng.Direction();
    const double gap = rng.Uniform(low, high) - CalcSeparation(a, b, d);
    b.p_WP = d * gap +
             FrameFromNormal(d) * Vector3(rng.Uniform(-0.02, 0.02), rng.Uniform(-0.02, 0.02), 0.0);
  }
};

double Deepest(const Manifold& manifold) {
  double phi = 1e9;
  for (int i = 0; i < manifold.size; ++i) phi = std::min(phi, manifold.points[i].phi);
  return phi;
}

// The signed distance of a world point to one of the pair's shapes, by the code of app/geometry.
double CalcDistance(const SignedDistance& distance, const PlacedConvex& placed,
                    const Vector3& p_W) {
  const RigidTransform X_WB =
      MakeTransform(placed.R_WP, placed.p_WP) * placed.convex->X_BP.inverse();
  return distance.Calc(X_WB.inverse() * p_W);
}

TEST(CollideTest, SupportPointsAreTheFarthestPointsOfTheSurface) {
  for (int i = 0; i < 100; ++i) {
    Rng rng(i, RngStream::kTest, 6);
    const RandomPair pair(i, rng, 0.0, 0.0);
    const Vector3 d = rng.Direction();
    const Vector3 support = CalcSupport(pair.a, d) + CoreRadius(*pair.a.convex) * d;
    const SignedDistance distance(pair.shape_a);
    EXPECT_NEAR(CalcDistance(distance, pair.a, support), 0.0, 1e-9) << pair.what;
    const RigidTransform X_WB =
        MakeTransform(pair.a.R_WP, pair.a.p_WP) * pair.a.convex->X_BP.inverse();
    for (int k = 0; k < 200; ++k) {
      const Vector3 p_W = X_WB * distance.Project(0.1 * rng.Direction(), nullptr);
      ASSERT_LT(d.dot(p_W - support), 1e-9) << pair.what;
    }
  }
}

TEST(CollideTest, OverlappingPairsOfAnyKindsTouchAsDeepAsTheyOverlapAlongTheLeastDepth) {
  const double margin = 1e-3, bias = 1.5e-4;  // faces win over edges within 1e-4
  int overlapping = 0;
  for (int i = 0; i < 600; ++i) {
    Rng rng(i, RngStream::kTest, 1);
    const RandomPair pair(i, rng, -0.004, 0.0);
    const double separation = FindSeparation(pair.a, pair.b, rng);
    if (separation > -bias) continue;
    ++overlapping;
    Manifold manifold;
    ASSERT_TRUE(Collide(pair.a, pair.b, margin, &manifold)) << pair.what;
    EXPECT_NEAR(manifold.nhat_W.norm(), 1.0, 1e-12) << pair.what;
    EXPECT_GT(CalcSeparation(pair.a, pair.b, manifold.nhat_W), separation - bias) << pair.what;
    EXPECT_NEAR(Deepest(manifold), separation, bias) << pair.what;
    ASSERT_LE(manifold.size, 4);
  }
  EXPECT_GT(overlapping, 30);
}

TEST(CollideTest, SeparatePairsNeverOverlapAndNearOnesAreSeen) {
  const double margin = 0.02;
  int near = 0;
  for (int i = 0; i < 400; ++i) {
    Rng rng(i, RngStream::kTest, 2);
    const RandomPair pair(i, rng, 0.001, 0.015);
    const double separation = FindSeparation(pair.a, pair.b, rng);
    Manifold manifold;
    const bool found = Collide(pair.a, pair.b, margin, &manifold);
    EXPECT_GT(Deepest(manifold), 0.0) << pair.what;
    if (separation < 0.003) continue;  // there, sliding past a face is told from flying at it
    if (separation < margin) {
      ++near;
      ASSERT_TRUE(found) << pair.what;
    } else {
      EXPECT_GT(Deepest(manifold), 0.5 * margin) << pair.what;
    }
  }
  EXPECT_GT(near, 100);
}

// Of 6000 pairs 13 points are farther off than 10 um, by up to 1.6 mm.
TEST(CollideTest, EveryPointLiesMidwayBetweenTheTwoSurfaces) {
  int points = 0, off = 0;
  for (int i = 0; i < 300; ++i) {
    Rng rng(i, RngStream::kTest, 7);
    RandomPair pair(i, rng, 0.0, 0.0);
    // A's +z end and an end, or a side, of B lie on each other, but for a millirad and a gap.
    const Matrix3 lie = RotationFromRpy(Vector3(i % 2 == 0 ? 0.0 : kPi / 2, 0, 0));
    const Matrix3 tilt = RotationFromRpy(1e-3 * rng.Direction());
    pair.b.R_WP = pair.a.R_WP * RotationFromRpy(Vector3(0, 0, i)) * tilt * lie;
    const Vector3 nhat = pair.a.R_WP.col(2), offset = 0.005 * rng.Direction();
    pair.b.p_WP = offset - offset.dot(nhat) * nhat;
    pair.b.p_WP += nhat * (rng.Uniform(-5e-4, 5e-4) - CalcSeparation(pair.a, pair.b, nhat));
    Manifold manifold;
    if (!Collide(pair.a, pair.b, 2e-3, &manifold)) continue;  // past a corner of a hull
    const SignedDistance distance_a(pair.shape_a), distance_b(pair.shape_b);
    for (int k = 0; k < manifold.size; ++k) {
      const ManifoldPoint& point = manifold.points[k];
      const Vector3 half = 0.5 * point.phi * manifold.nhat_W;
      const double error = std::max(std::abs(CalcDistance(distance_a, pair.a, point.p_W - half)),
                                    std::abs(CalcDistance(distance_b, pair.b, point.p_W + half)));
      EXPECT_LT(error, 2e-3) << pair.what;
      off += !(error < 1e-5);
      ++points;
    }
  }
  EXPECT_GT(points, 300);
  EXPECT_LE(off, points / 100);
}

TEST(CollideTest, SwappingThePairTurnsTheNormalAndKeepsThePoints) {
  for (int i = 0; i < 300; ++i) {
    Rng rng(i, RngStream::kTest, 3);
    const RandomPair pair(i, rng, -0.003, 0.001);
    Manifold ab, ba;
    ASSERT_EQ(Collide(pair.a, pair.b, 2e-3, &ab), Collide(pair.b, pair.a, 2e-3, &ba));
    ASSERT_EQ(ab.size, ba.size) << pair.what;
    if (ab.size == 0) continue;
    EXPECT_EQ(ab.nhat_W, -ba.nhat_W) << pair.what;
    for (int k = 0; k < ab.size; ++k) EXPECT_EQ(ab.points[k].p_W, ba.points[k].p_W) << pair.what;
  }
}

TEST(CollideTest, MovingThePairMovesItsContact) {
  for (int i = 0; i < 300; ++i) {
    Rng rng(i, RngStream::kTest, 4);
    RandomPair pair(i, rng, -0.003, 0.001);
    Manifold before, after;
    const bool found = Collide(pair.a, pair.b, 2e-3, &before);
    const RigidTransform X = MakeTransform(rng.Rotation(), Vector3(0.3, -0.2, 0.5));
    for (PlacedConvex* placed : {&pair.a, &pair.b}) {
      placed->R_WP = X.linear() * placed->R_WP;
      placed->p_WP = X * placed->p_WP;
    }
    ASSERT_EQ(Collide(pair.a, pair.b, 2e-3, &after), found) << pair.what;
    if (!found) continue;
    EXPECT_LT((X.linear() * before.nhat_W - after.nhat_W).norm(), 1e-5) << pair.what;
    EXPECT_NEAR(Deepest(before), Deepest(after), 1e-7) << pair.what;
  }
}

// A placed piece that owns its shape.
struct Piece {
  std::vector<Convex> shapes;
  PlacedConvex placed;

  Piece(const Shape& shape, const RigidTransform& X_WB) : shapes(BuildConvexPieces(shape)) {
    placed.convex = shapes.data();
    const RigidTransform X_WP = X_WB * shapes[0].X_BP;
    placed.R_WP = X_WP.linear();
    placed.p_WP = X_WP.translation();
  }
};

TEST(CollideTest, ACylinderOnAFaceTouchesWithItsRimAndOnItsSideWithALine) {
  const Piece table(Box{Vector3(1, 1, 0.1)}, At(0, 0, -0.05));
  const double r = 0.03, h = 0.1;
  Manifold manifold;
  const Piece upright(Cylinder{r, h}, At(0.1, 0.2, 0.5 * h));
  ASSERT_TRUE(Collide(table.placed, upright.placed, 1e-4, &manifold));
  ASSERT_EQ(manifold.size, 4);
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR((manifold.points[i].p_W - Vector3(0.1, 0.2, 0)).norm(), r, 1e-12);
    EXPECT_NEAR(manifold.points[i].phi, 0.0, 1e-12);
  }
  for (const double yaw : {0.0, 30.0, 45.0}) {
    const Piece lying(Cylinder{r, h}, At(0.1, 0.2, r, Vector3(90, 0, yaw)));
    ASSERT_TRUE(Collide(table.placed, lying.placed, 1e-4, &manifold));
    ASSERT_EQ(manifold.size, 2);
    EXPECT_NEAR((manifold.points[0].p_W - manifold.points[1].p_W).norm(), h, 1e-12);
    EXPECT_NEAR(manifold.points[0].phi, 0.0, 1e-12);
  }
  // Tilted, its lowest point is exact in every direction.
  for (int i = 0; i < 12; ++i) {
    const double tilt = DegToRad(20.0), turn = 0.5 * i;
    const Matrix3 R = RotationFromRpy(Vector3(0, 0, turn)) * RotationFromRpy(Vector3(tilt, 0, 0));
    const double z = 0.5 * h * std::cos(tilt) + r * std::sin(tilt);
    const Piece tilted(Cylinder{r, h}, MakeTransform(R, Vector3(0, 0, z)));
    ASSERT_TRUE(Collide(table.placed, tilted.placed, 1e-4, &manifold));
    ASSERT_EQ(manifold.size, 1);
    EXPECT_NEAR(manifold.points[0].phi, 0.0, 1e-12);
  }
}

TEST(CollideTest, ADiscOverATablesEdgeIsHeldByTheChordOfTheEdge) {
  const Piece table(Box{Vector3(1, 1, 0.1)}, At(0, 0, -0.05));
  const double r = 0.1;
  const Piece disc(Cylinder{r, 0.01}, At(0.46, 0, 0.005));
  Manifold manifold;
  ASSERT_TRUE(Collide(table.placed, disc.placed, 1e-4, &manifold));
  double x_max = -1.0, half_chord = 0.0;
  for (int i = 0; i < manifold.size; ++i) {
    x_max = std::max(x_max, manifold.points[i].p_W.x());
    if (manifold.points[i].p_W.x() > 0.499) {
      half_chord = std::max(half_chord, std::abs(manifold.points[i].p_W.y()));
    }
  }
  EXPECT_NEAR(x_max, 0.5, 2e-6);
  EXPECT_NEAR(half_chord, std::sqrt(r * r - 0.04 * 0.04), 1e-5);
}

TEST(CollideTest, ParallelBottlesTouchAlongALine) {
  const Piece a(Cylinder{0.033, 0.2}, At(0, 0, 0.1));
  const Piece b(Cylinder{0.024, 0.11}, At(0.0565, 0.01, 0.055));
  Manifold manifold;
  ASSERT_TRUE(Collide(a.placed, b.placed, 1e-3, &manifold));
  ASSERT_EQ(manifold.size, 2);
  const double gap = std::hypot(0.0565, 0.01) - 0.033 - 0.024;
  for (int i = 0; i < 2; ++i) EXPECT_NEAR(manifold.points[i].phi, gap, 1e-9);
  EXPECT_NEAR(std::abs(manifold.points[0].p_W.z() - manifold.points[1].p_W.z()), 0.11, 1e-9);
  EXPECT_LT((manifold.nhat_W - Vector3(0.0565, 0.01, 0).normalized()).norm(), 1e-9);
}

TEST(CollideTest, CrossedEdgesTouchInOnePoint) {
  // Two square bars lie across each other on their edges.
  const double a = 0.02, gap = 1e-5;
  const Piece lower(Box{Vector3(0.3, a, a)}, At(0, 0, 0, Vector3(45, 0, 0)));
  const Piece upper(Box{Vector3(a, 0.3, a)},
                    At(0.01, 0.02, std::sqrt(2.0) * a + gap, Vector3(0, 45, 0)));
  Manifold manifold;
  ASSERT_TRUE(Collide(lower.placed, upper.placed, 1e-4, &manifold));
  ASSERT_EQ(manifold.size, 1);
  EXPECT_NEAR(manifold.points[0].phi, gap, 1e-12);
  EXPECT_LT((manifold.points[0].p_W.head<2>() - Vector2(0.01, 0.0)).norm(), 1e-12);
  EXPECT_LT((manifold.nhat_W - Vector3::UnitZ()).norm(), 1e-12);
}

TEST(CollideTest, BooksSideBySideOnATableTouchOnTheirCoversAlone) {
  // Their lower edges are level, so a corner is as near to the neighbour's bottom as to its cover.
  const Piece a(Box{Vector3(0.15, 0.03, 0.2)}, At(0, 0, 0.1));
  const Piece b(Box{Vector3(0.15, 0.03, 0.2)}, At(0, 0.03 + 2e-5, 0.1 - 3e-7));
  Manifold manifold;
  ASSERT_TRUE(Collide(a.placed, b.placed, 1e-4, &manifold));
  EXPECT_LT((manifold.nhat_W - Vector3::UnitY()).norm(), 1e-12);
  ASSERT_EQ(manifold.size, 4);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(manifold.points[i].phi, 2e-5, 1e-12);
}

TEST(GjkTest, NearestPointsOfSeparateShapesAreExact) {
  int apart = 0;
  for (int i = 0; i < 500; ++i) {
    Rng rng(i, RngStream::kTest, 5);
    const RandomPair pair(i, rng, 0.0, 0.01);
    const CoreDistance cores = CalcCoreDistance(pair.a, pair.b);
    if (!cores.apart) continue;
    ++apart;
    EXPECT_NEAR((cores.p_WB - cores.p_WA).norm(), cores.distance, 1e-12);
    // The bound from the other side: the separation along the direction found.
    const double radii = CoreRadius(*pair.a.convex) + CoreRadius(*pair.b.convex);
    EXPECT_NEAR(CalcSeparation(pair.a, pair.b, cores.nhat_W) + radii, cores.distance,
                1e-5 * cores.distance)
        << pair.what;
  }
  EXPECT_GT(apart, 300);
}

}  // namespace
}  // namespace pregrasp
