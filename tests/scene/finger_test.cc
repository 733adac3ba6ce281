#include "app/scene/finger.h"

#include <gtest/gtest.h>

namespace pregrasp {
namespace {

TEST(FingerTest, TipsThatTouchEachOtherAreTheSumOfTheirRadiiApart) {
  const TipSpheres spheres;
  const Vector3 p(0.3, -0.2, 0.1), along = Vector3(1.0, 2.0, 2.0) / 3.0;
  EXPECT_NEAR(spheres.CalcGap(Finger::kIndex, p, Finger::kLittle, p + 0.018 * along), 0.0, 1e-12);
  EXPECT_NEAR(spheres.CalcGap(Finger::kThumb, p, Finger::kIndex, p + 0.0199 * along), 0.0, 1e-12);
  EXPECT_NEAR(spheres.CalcGap(Finger::kIndex, p + 0.0199 * along, Finger::kThumb, p), 0.0, 1e-12);
  EXPECT_NEAR(spheres.CalcGap(Finger::kRing, p, Finger::kMiddle, p), -0.018, 1e-12);
}

TEST(FingerTest, ATipIsARadiusAboveItsContact) {
  const Vector3 centre = TipSpheres{}.Centre(Finger::kThumb, {0.01, 0.02, 0.03}, -Vector3::UnitY());
  EXPECT_TRUE(centre.isApprox(Vector3(0.01, 0.0091, 0.03), 1e-12));
}

}  // namespace
}  // namespace pregrasp
