#include "app/geometry/solids.h"

#include <gtest/gtest.h>

#include "app/geometry/mesh_topology.h"
#include "app/geometry/tessellate.h"
#include "tests/geometry/test_shapes.h"

namespace pregrasp {
namespace {

using testing::At;

TriangleMesh BoxAt(const Vector3& size, const Vector3& p, bool turned = false) {
  TriangleMesh mesh = Transformed(Tessellate(Box{size}), At(p.x(), p.y(), p.z()));
  if (turned) mesh.F.col(1).swap(mesh.F.col(2));
  return mesh;
}

TriangleMesh Together(const std::vector<TriangleMesh>& parts) {
  TriangleMesh mesh = parts.front();
  for (std::size_t i = 1; i < parts.size(); ++i) AppendMesh(mesh, parts[i]);
  return mesh;
}

TEST(SolidsTest, WhatStandsApartStaysOneMesh) {
  const auto apart =
      SeparateSolids(Together({BoxAt({1, 1, 1}, {0, 0, 0}), BoxAt({1, 1, 1}, {1.5, 0, 0}, true)}));
  ASSERT_EQ(apart.size(), 1U);
  EXPECT_NEAR(CalcVolume(apart[0]), 2.0, 1e-12);
}

TEST(SolidsTest, WhatOverlapsOrTouchesIsASolidOfItsOwnAndOutward) {
  for (const double gap : {-0.3, 0.0}) {
    const auto solids = SeparateSolids(
        Together({BoxAt({2, 2, 1}, {0, 0, 0}, true), BoxAt({0.5, 0.5, 0.5}, {5, 0, 0}),
                  BoxAt({0.6, 0.6, 1}, {0.2, 0.1, 1.0 + gap})}));
    ASSERT_EQ(solids.size(), 3U) << gap;
    EXPECT_NEAR(CalcVolume(solids[0]), 4.0, 1e-12);
    EXPECT_NEAR(CalcVolume(solids[1]), 0.36, 1e-12);
    EXPECT_NEAR(CalcVolume(solids[2]), 0.125, 1e-12) << "the one that stands apart comes last";
  }
}

// A bar through two walls has all its corners in solid matter: no cavity for that.
TEST(SolidsTest, ABarWithItsEndsInWallsIsNoCavityOfThem) {
  const auto solids =
      SeparateSolids(Together({BoxAt({0.2, 1, 1}, {-1, 0, 0}), BoxAt({0.2, 1, 1}, {1, 0, 0}),
                               BoxAt({2.1, 0.1, 0.1}, {0, 0.2, 0.1}, true)}));
  ASSERT_EQ(solids.size(), 3U);
  for (const TriangleMesh& solid : solids) EXPECT_GT(CalcVolume(solid), 0.0);
}

TEST(SolidsTest, CavitiesStayWithTheSolidThatTheyAreIn) {
  const auto solids = SeparateSolids(
      Together({BoxAt({2, 2, 2}, {0, 0, 0}), BoxAt({1, 1, 1}, {-0.2, 0, 0}),
                BoxAt({0.3, 0.3, 0.3}, {-0.2, 0, 0}), BoxAt({1, 1, 1}, {1.4, 0, 0})}));
  ASSERT_EQ(solids.size(), 3U);
  EXPECT_NEAR(CalcVolume(solids[0]), 8.0 - 1.0, 1e-12);
  EXPECT_NEAR(CalcVolume(solids[1]), 1.0, 1e-12);
  EXPECT_NEAR(CalcVolume(solids[2]), 0.027, 1e-12) << "an island in the cavity is solid";
}

}  // namespace
}  // namespace pregrasp
