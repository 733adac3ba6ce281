#include "app/hand/forearm.h"

#include <gtest/gtest.h>

#include "app/geometry/mass_properties.h"

namespace pregrasp {
namespace {

// A ball, and a slab with its upper face at z = 0. The hand points along +x, its palm's frame at
// `p_WH`: the forearm lies along -x, 15 mm thick to all sides.
class ForearmTest : public ::testing::Test {
 protected:
  ForearmTest() {
    Body ball, slab;
    ball.name = "ball";
    ball.shape = Sphere{0.03};
    ball.mass_properties = CalcMassProperties(ball.shape, 0.1);
    slab.name = "slab";
    slab.shape = Box{{1.0, 1.0, 0.02}};
    scene_.bodies = {ball, slab};
  }

  bool IsFree(const Vector3& p_WBall, const Vector3& p_WH) const {
    const std::vector<RigidTransform> X_WB = {At(p_WBall), At({0.0, 0.0, -0.01})};
    const Matrix3 R_WH = RotationFromRpy({0.0, 0.5 * kPi, 0.0});  // its z along +x
    return Forearm(scene_, ShadowHand()).IsFree(X_WB, MakeTransform(R_WH, p_WH));
  }

  static RigidTransform At(const Vector3& p) { return MakeTransform(Quaternion::Identity(), p); }

  const Vector3 far_{0.0, 0.0, 0.4};
  Scene scene_;
};

TEST_F(ForearmTest, LiesFifteenMillimetresAboveWhatItMayNotEnter) {
  EXPECT_TRUE(IsFree(far_, {0.0, 0.0, 0.0152}));
  EXPECT_FALSE(IsFree(far_, {0.0, 0.0, 0.0148}));
}

TEST_F(ForearmTest, ReachesTwentyCentimetresBehindThePalmAndNoFurther) {
  // The ball's centre on the axis: it touches the rounded end at 0.20 + 0.015 + 0.03.
  EXPECT_FALSE(IsFree({-0.2445, 0.0, 0.2}, {0.0, 0.0, 0.2}));
  EXPECT_TRUE(IsFree({-0.2455, 0.0, 0.2}, {0.0, 0.0, 0.2}));
  // Beside its middle, and where the hand itself begins.
  EXPECT_FALSE(IsFree({-0.12, 0.0446, 0.2}, {0.0, 0.0, 0.2}));
  EXPECT_TRUE(IsFree({-0.12, 0.0454, 0.2}, {0.0, 0.0, 0.2}));
  EXPECT_TRUE(IsFree({0.02, 0.0, 0.2}, {0.0, 0.0, 0.2}));
}

}  // namespace
}  // namespace pregrasp
