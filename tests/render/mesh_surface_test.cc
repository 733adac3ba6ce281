#include "render/mesh_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/render/sample_scenes.h"

namespace pregrasp {
namespace {

Vector3 ToVector(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }

TEST(ShadedSurfaceTest, ABallsSmoothNormalsPointOutwardFromItsCentre) {
  const ShadedSurface surface = BuildShadedSurface(BallMesh(0.02), true);
  for (const auto& vertex : surface.vertices) {
    EXPECT_GT(ToVector(vertex.n).dot(ToVector(vertex.p).normalized()), 0.995);
    EXPECT_NEAR(ToVector(vertex.n).norm(), 1.0, 1e-6);
  }
}

TEST(ShadedSurfaceTest, ABoxStaysFlatAndSharesCornersWithinAFace) {
  const ShadedSurface surface = BuildShadedSurface(BoxMesh({1, 2, 3}), true);
  EXPECT_EQ(surface.vertices.size(), 24U);  // four a face
  EXPECT_EQ(surface.indices.size(), 36U);
  for (const auto& vertex : surface.vertices) {
    EXPECT_NEAR(ToVector(vertex.n).cwiseAbs().maxCoeff(), 1.0, 1e-6);
    EXPECT_GT(ToVector(vertex.n).dot(ToVector(vertex.p)), 0.0);
  }
}

TEST(ShadedSurfaceTest, VerticesAtOnePlaceCountAsOne) {
  // The same ball with three vertices of its own for each triangle.
  const TriangleMesh ball = BallMesh(0.02);
  TriangleMesh soup;
  soup.V.resize(3 * ball.F.rows(), 3);
  soup.F.resize(ball.F.rows(), 3);
  for (Eigen::Index f = 0; f < ball.F.rows(); ++f) {
    for (int corner = 0; corner < 3; ++corner) {
      soup.V.row(3 * f + corner) = ball.V.row(ball.F(f, corner));
      soup.F(f, corner) = static_cast<int>(3 * f + corner);
    }
  }
  EXPECT_EQ(BuildShadedSurface(soup, true).vertices.size(),
            BuildShadedSurface(ball, true).vertices.size());
}

TEST(ClosedMeshTest, ABallIsClosedAndABallWithAHoleIsNot) {
  TriangleMesh mesh = BallMesh(0.02);
  EXPECT_TRUE(IsClosedMesh(mesh));
  mesh.F.conservativeResize(mesh.F.rows() - 1, 3);
  EXPECT_FALSE(IsClosedMesh(mesh));
  EXPECT_FALSE(IsClosedMesh(UnitOpenCone(12)));
  EXPECT_FALSE(IsClosedMesh(TriangleMesh{}));
}

TEST(ShadedEdgesTest, ABoxHasTwelveCreasesAndEighteenEdges) {
  EXPECT_EQ(BuildShadedEdges(BoxMesh({1, 1, 1}), true).size(), 12U);
  EXPECT_EQ(BuildShadedEdges(BoxMesh({1, 1, 1}), false).size(), 18U);
}

TEST(ShadedEdgesTest, OnlyConvexCreasesCount) {
  // A ring with an inner wall: its floor's inner corner is concave.
  const TriangleMesh cup = RevolvedMesh({{0, 0}, {2, 0}, {2, 3}, {1.5, 3}, {1.5, 1}, {0, 1}}, 24);
  std::set<std::pair<double, double>> rings;
  for (const ShadedEdge& edge : BuildShadedEdges(cup, true)) {
    const Vector3 p = ToVector(edge.p), q = ToVector(edge.q);
    ASSERT_NEAR(p.z(), q.z(), 1e-6);
    rings.emplace(std::round(p.head<2>().norm() * 10), std::round(p.z() * 10));
  }
  const std::set<std::pair<double, double>> convex = {{20, 0}, {20, 30}, {15, 30}};
  EXPECT_EQ(rings, convex);
}

}  // namespace
}  // namespace pregrasp
