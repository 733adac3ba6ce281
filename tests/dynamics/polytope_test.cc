#include "app/dynamics/polytope.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/dynamics/scenes.h"

namespace pregrasp {
namespace {

// Faces are convex loops in their planes, seen counter-clockwise from outside, and close the solid.
void ExpectClosed(const Polytope& polytope) {
  std::set<std::pair<int, int>> edges;
  for (const Polytope::Face& face : polytope.faces) {
    ASSERT_GE(face.count, 3);
    for (int i = 0; i < face.count; ++i) {
      const int from = polytope.corners[face.first + i];
      const int to = polytope.corners[face.first + (i + 1) % face.count];
      EXPECT_TRUE(edges.insert({from, to}).second);
      const Vector3 edge = polytope.vertices[to] - polytope.vertices[from];
      for (int k = 0; k < face.count; ++k) {
        const Vector3 r = polytope.corner(face, k) - polytope.vertices[from];
        EXPECT_GT(face.nhat.dot(edge.cross(r)), -1e-9);
      }
    }
    for (const Vector3& vertex : polytope.vertices) {
      EXPECT_LE(face.nhat.dot(vertex), face.offset + 1e-15);
    }
  }
  for (const auto& [from, to] : edges) EXPECT_TRUE(edges.count({to, from}));
}

TEST(PolytopeTest, ABoxHasSixFacesOfFourCorners) {
  const Polytope box = MakeBoxPolytope(Vector3(1, 2, 3));
  EXPECT_EQ(box.faces.size(), 6U);
  ExpectClosed(box);
}

TEST(PolytopeTest, TrianglesInOnePlaneBecomeOneFace) {
  MatrixX3 P(32, 3);
  for (int i = 0; i < 16; ++i) {
    const double angle = 2.0 * kPi * i / 16;
    P.row(i) << 0.05 * std::cos(angle), 0.05 * std::sin(angle), 0.0;
    P.row(16 + i) << 0.06 * std::cos(angle), 0.06 * std::sin(angle), 0.07;
  }
  const Polytope prism = MakePolytope(CalcConvexHull(P));
  EXPECT_EQ(prism.faces.size(), 18U);
  ExpectClosed(prism);
}

TEST(PolytopeTest, CoordinatesRoundedAsInAMeshFileStillMerge) {
  MatrixX3 P(64, 3);
  for (int i = 0; i < 64; ++i) {
    const double angle = 2.0 * kPi * (i % 32) / 32;
    Vector3 p(0.05 * std::cos(angle), 0.05 * std::sin(angle), i < 32 ? 0.0 : 0.03);
    p = Vector3(RotationFromRpy(Vector3(0.3, 0.2, 0.1)) * p);
    for (int k = 0; k < 3; ++k) P(i, k) = std::round(p[k] * 1e6) * 1e-6;
  }
  const Polytope prism = MakePolytope(CalcConvexHull(P));
  EXPECT_LT(prism.faces.size(), 40U);
  int largest = 0;
  for (const Polytope::Face& face : prism.faces) largest = std::max(largest, face.count);
  EXPECT_GE(largest, 30);
}

TEST(PolytopeTest, RandomHullsStayClosed) {
  for (int seed = 0; seed < 20; ++seed) {
    Rng rng(seed);
    const Shape shape = MakeRandomHull(rng, 40, Vector3(0.05, 0.04, 0.03));
    ExpectClosed(MakePolytope(std::get<Mesh>(shape).mesh));
  }
}

}  // namespace
}  // namespace pregrasp
