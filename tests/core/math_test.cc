#include "app/core/math.h"

#include <gtest/gtest.h>

#include "app/core/rng.h"

namespace pregrasp {
namespace {

TEST(RotationFromRpyTest, AppliesRollThenPitchThenYawAboutFixedAxes) {
  const Matrix3 R = RotationFromRpy({kPi / 2, 0, kPi / 2});
  EXPECT_TRUE((R * Vector3::UnitY()).isApprox(Vector3::UnitZ(), 1e-14));
  EXPECT_TRUE((R * Vector3::UnitX()).isApprox(Vector3::UnitY(), 1e-14));
}

TEST(FrameFromNormalTest, IsRightHandedOrthonormalWithTheNormalAsZ) {
  Rng rng(7);
  for (int i = 0; i < 1000; ++i) {
    const Vector3 nhat = i == 0 ? Vector3(0, 0, -1) : rng.Direction();
    const Matrix3 R = FrameFromNormal(nhat);
    EXPECT_LT((R.transpose() * R - Matrix3::Identity()).norm(), 1e-12);
    EXPECT_NEAR(R.determinant(), 1.0, 1e-12);
    EXPECT_EQ(R.col(2), nhat);
  }
}

TEST(RotationAngleTest, MeasuresSmallAnglesExactlyAndIsSymmetric) {
  Rng rng(3);
  for (const double angle : {1e-9, 1e-3, 0.5, 3.0}) {
    const Matrix3 R_WA = rng.Rotation().toRotationMatrix();
    const Matrix3 R_WB = R_WA * Eigen::AngleAxisd(angle, rng.Direction()).toRotationMatrix();
    EXPECT_NEAR(RotationAngle(R_WA, R_WB), angle, 1e-12);
    EXPECT_NEAR(RotationAngle(R_WB, R_WA), angle, 1e-12);
  }
}

}  // namespace
}  // namespace pregrasp
