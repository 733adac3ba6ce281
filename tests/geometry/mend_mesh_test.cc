#include "app/geometry/mend_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "app/geometry/mesh_topology.h"
#include "app/geometry/tessellate.h"
#include "tests/geometry/test_shapes.h"

namespace pregrasp {
namespace {

// A ball of 5 cm without the faces around `holes` vertices.
TriangleMesh Ball(const std::vector<int>& holes) {
  const TriangleMesh ball = Tessellate(Sphere{0.05}, 96);
  std::vector<bool> keep(ball.F.rows(), true);
  for (int f = 0; f < ball.F.rows(); ++f) {
    for (const int v : holes) keep[f] = keep[f] && !(ball.F.row(f).array() == v).any();
  }
  return TakeFaces(ball, keep);
}

TEST(MendMeshTest, ClosesTinyHolesAndSaysSo) {
  const double volume = CalcVolume(Ball({}));
  const auto some = static_cast<int>(Ball({}).V.rows());
  TriangleMesh mesh = Ball({some / 3, some / 2});
  ASSERT_FALSE(FindDefects(mesh).closed());
  const Mending mending = MendMesh(mesh);
  EXPECT_TRUE(FindDefects(mesh).closed());
  EXPECT_EQ(mending.closed_holes, 2);
  EXPECT_EQ(mending.Text().find("2 holes closed, the largest "), 0U) << mending.Text();
  EXPECT_NEAR(CalcVolume(mesh), volume, 1e-3 * volume);
}

TEST(MendMeshTest, AnOpeningStaysOpen) {
  const TriangleMesh box = Tessellate(Box{Vector3(0.1, 0.1, 0.1)});
  std::vector<bool> keep(box.F.rows(), true);
  keep[0] = false;
  TriangleMesh mesh = TakeFaces(box, keep);
  EXPECT_EQ(MendMesh(mesh).Text(), "");
  EXPECT_EQ(FindDefects(mesh).open_edges, 3);
}

TEST(MendMeshTest, LeavesOutFacesGivenTwiceTurnedRoundOrNot) {
  const TriangleMesh box = Tessellate(Box{Vector3(0.1, 0.04, 0.02)});
  TriangleMesh mesh = box;
  const auto count = box.F.rows();
  mesh.F.conservativeResize(2 * count, 3);
  for (int f = 0; f < count; ++f) {
    mesh.F.row(count + f) << box.F(f, 0), box.F(f, f % 2 ? 1 : 2), box.F(f, f % 2 ? 2 : 1);
  }
  const Mending mending = MendMesh(mesh);
  EXPECT_EQ(mending.dropped_faces, count);
  EXPECT_EQ(mesh.F, box.F);
  EXPECT_EQ(mending.Text(), "12 faces given twice left out");
}

TEST(MendMeshTest, MergesTheCornersOfACrack) {
  // The box's top, whose corners are a little beside those of the sides.
  TriangleMesh mesh = Tessellate(Box{Vector3(0.1, 0.1, 0.1)});
  const auto corners = mesh.V.rows();
  mesh.V.conservativeResize(2 * corners, 3);
  mesh.V.bottomRows(corners) = mesh.V.topRows(corners).array() + 4e-6;
  for (int f = 0; f < mesh.F.rows(); ++f) {
    bool top = true;
    for (int i = 0; i < 3; ++i) top = top && mesh.V(mesh.F(f, i), 2) > 0.0;
    if (top) mesh.F.row(f).array() += static_cast<int>(corners);
  }
  mesh = TakeFaces(mesh, std::vector<bool>(mesh.F.rows(), true));
  ASSERT_EQ(FindDefects(mesh).open_edges, 8);
  const Mending mending = MendMesh(mesh);
  EXPECT_EQ(mending.merged_corners, 4);
  EXPECT_TRUE(FindDefects(mesh).closed());
  EXPECT_EQ(mending.Text(), "4 corners merged with ones beside them");
}

TEST(MendMeshTest, ARimThatTouchesItselfStaysOpen) {
  // Two holes of the ball that share a corner.
  TriangleMesh mesh = Ball({});
  const auto neighbours = FindNeighbours(mesh);
  const int corner = mesh.F(200, 0);
  std::vector<int> around;
  for (int f = 0; f < mesh.F.rows(); ++f) {
    if ((mesh.F.row(f).array() == corner).any()) around.push_back(f);
  }
  ASSERT_GE(around.size(), 4U);
  std::vector<bool> keep(mesh.F.rows(), true);
  keep[around[0]] = false;
  for (const int f : around) {
    const auto& across = neighbours[around[0]];
    if (f != around[0] && std::find(across.begin(), across.end(), f) == across.end()) {
      keep[f] = false;
      break;
    }
  }
  mesh = TakeFaces(mesh, keep);
  ASSERT_EQ(FindDefects(mesh).open_edges, 6);
  EXPECT_EQ(MendMesh(mesh).closed_holes, 0);
}

}  // namespace
}  // namespace pregrasp
