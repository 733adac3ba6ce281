#include "app/geometry/mesh_topology.h"

#include <gtest/gtest.h>

#include "tests/geometry/test_shapes.h"

namespace pregrasp {
namespace {

TEST(MeshTopologyTest, FindsNeighboursAcrossEachEdge) {
  const TriangleMesh mesh = testing::MakeTorus(0.04, 0.01, 7, 5);
  const auto neighbours = FindNeighbours(mesh);
  for (int f = 0; f < mesh.F.rows(); ++f) {
    for (int i = 0; i < 3; ++i) {
      const int g = neighbours[f][i];
      ASSERT_GE(g, 0);
      bool shared = false;
      for (int j = 0; j < 3; ++j) {
        shared = shared ||
                 (mesh.F(g, j) == mesh.F(f, (i + 1) % 3) && mesh.F(g, (j + 1) % 3) == mesh.F(f, i));
      }
      EXPECT_TRUE(shared);
    }
  }
}

TEST(MeshTopologyTest, TheEulerNumberTellsABallFromARing) {
  EXPECT_EQ(CalcEulerNumber(Tessellate(Sphere{1.0}, 12)), 2);
  EXPECT_EQ(CalcEulerNumber(testing::MakeCup(0.04, 0.1, 0.003, 12)), 2);
  EXPECT_EQ(CalcEulerNumber(testing::MakeTorus(0.04, 0.01, 12, 8)), 0);
}

TEST(MeshTopologyTest, WeldingWithinATolerancePullsChainsTogether) {
  TriangleMesh mesh;
  mesh.V.resize(6, 3);
  mesh.V << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1e-9, 0, 0, 2e-9, 0, 0;
  mesh.F.resize(4, 3);
  mesh.F << 0, 2, 1, 4, 1, 3, 5, 3, 2, 1, 2, 3;
  EXPECT_FALSE(FindDefects(WeldVertices(mesh, 0.0)).closed());
  const TriangleMesh welded = WeldVertices(mesh, 1.5e-9);
  EXPECT_EQ(welded.V.rows(), 4);
  EXPECT_TRUE(FindDefects(welded).closed());
}

TEST(MeshTopologyTest, TheWindingNumberIsOneInsideAndZeroOutside) {
  const TriangleMesh mesh = testing::MakeBowl(0.1, 0.01, 8, 16);
  EXPECT_NEAR(CalcWindingNumber(mesh, {0, 0, -0.095}), 1.0, 1e-9);
  EXPECT_NEAR(CalcWindingNumber(mesh, {0, 0, -0.05}), 0.0, 1e-9);
}

}  // namespace
}  // namespace pregrasp
