#include "app/geometry/tessellate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "app/geometry/mass_properties.h"
#include "app/geometry/signed_distance.h"
#include "tests/geometry/test_shapes.h"

namespace pregrasp {
namespace {

TEST(TessellateTest, IsClosedOutwardAndOnTheSurface) {
  for (const testing::NamedShape& named : testing::ShapesOfEveryKind()) {
    const TriangleMesh mesh = Tessellate(named.shape, 20);
    EXPECT_TRUE(FindDefects(mesh).closed()) << named.name;
    EXPECT_GT(CalcVolume(mesh), 0.0) << named.name;
    if (named.name == "union") continue;  // its parts' vertices may lie inside another part
    const SignedDistance distance(named.shape);
    for (int v = 0; v < mesh.V.rows(); ++v) {
      EXPECT_NEAR(distance.Calc(mesh.V.row(v)), 0.0, 1e-15) << named.name;
    }
  }
}

TEST(TessellateTest, ApproachesTheVolumeInSecondOrder) {
  for (const testing::NamedShape& named : testing::ShapesOfEveryKind()) {
    if (std::holds_alternative<Union>(named.shape)) continue;
    const double exact = CalcVolume(named.shape);
    const double coarse = exact - CalcVolume(Tessellate(named.shape, 24));
    const double fine = exact - CalcVolume(Tessellate(named.shape, 96));
    EXPECT_GE(fine, -1e-15) << named.name;
    EXPECT_LE(fine, coarse / 14.0 + 1e-15) << named.name;
  }
}

TEST(TessellateTest, ABallHasNoSeamAtItsEquator) {
  const TriangleMesh mesh = Tessellate(Sphere{1.0}, 16);
  EXPECT_EQ(CalcEulerNumber(mesh), 2);
  EXPECT_EQ(WeldVertices(mesh, 1e-9).V.rows(), mesh.V.rows());
}

}  // namespace
}  // namespace pregrasp
