#include "app/geometry/mass_properties.h"

#include <gtest/gtest.h>

#include <cmath>

#include "app/core/rng.h"
#include "tests/geometry/test_shapes.h"

namespace pregrasp {
namespace {

using testing::At;
using testing::MakeMesh;

TEST(MassPropertiesTest, OfPrimitivesAreTheTextbookOnes) {
  const MassProperties box = CalcMassProperties(Box{Vector3(1, 2, 3)}, 12.0);
  EXPECT_TRUE(box.p_BoBcm.isZero(1e-15));
  EXPECT_TRUE(box.I_BBcm.isApprox(Matrix3(Vector3(13, 10, 5).asDiagonal()), 1e-14));
  const MassProperties cylinder = CalcMassProperties(Cylinder{2.0, 6.0}, 12.0);
  EXPECT_TRUE(cylinder.I_BBcm.isApprox(Matrix3(Vector3(48, 48, 24).asDiagonal()), 1e-14));
  const MassProperties sphere = CalcMassProperties(Sphere{2.0}, 5.0);
  EXPECT_TRUE(sphere.I_BBcm.isApprox(8.0 * Matrix3::Identity(), 1e-14));
  // A capsule: cylinder plus two half balls of the same density.
  const double r = 0.5, h = 2.0;
  const double v_c = kPi * r * r * h, v_s = 4.0 / 3.0 * kPi * r * r * r;
  const double across =
      v_c * (h * h / 12 + r * r / 4) + v_s * (0.4 * r * r + h * h / 4 + 3.0 / 8.0 * h * r);
  const double along = v_c * r * r / 2 + v_s * 0.4 * r * r;
  const MassProperties capsule = CalcMassProperties(Capsule{r, h}, v_c + v_s);
  EXPECT_TRUE(capsule.I_BBcm.isApprox(Matrix3(Vector3(across, across, along).asDiagonal()), 1e-14));
}

TEST(MassPropertiesTest, OfAMovedBoxMeshAreThoseOfTheMovedBox) {
  Rng rng(1);
  const Box box{Vector3(0.3, 0.03, 0.1)};
  const MassProperties expected = CalcMassProperties(box, 2.0);
  for (int i = 0; i < 20; ++i) {
    const Matrix3 R = rng.Rotation().toRotationMatrix();
    const Vector3 t = 10.0 * rng.Direction();
    const Shape mesh = MakeMesh(Transformed(Tessellate(box), MakeTransform(R, t)));
    const MassProperties got = CalcMassProperties(mesh, 2.0);
    EXPECT_NEAR((got.p_BoBcm - t).norm(), 0.0, 1e-13);
    EXPECT_LT((got.I_BBcm - R * expected.I_BBcm * R.transpose()).norm(), 1e-13);
  }
}

TEST(MassPropertiesTest, OfARoundMeshApproachThoseOfTheRoundShape) {
  double last = 1.0;
  for (const int segments : {16, 32, 64, 128}) {
    const Shape mesh = MakeMesh(Tessellate(Capsule{0.02, 0.1}, segments));
    const Matrix3 exact = CalcMassProperties(Capsule{0.02, 0.1}, 1.0).I_BBcm;
    const double error = (CalcMassProperties(mesh, 1.0).I_BBcm - exact).norm() / exact.norm();
    EXPECT_LT(error, 0.3 * last);  // second order: a quarter
    last = error;
  }
}

TEST(MassPropertiesTest, AUnionOfFlushBoxesIsExactlyTheBoxTheyMake) {
  Union whole;
  whole.parts.push_back({Box{Vector3(0.1, 0.2, 0.3)}, At(0.05, 0, 0)});
  whole.parts.push_back({Box{Vector3(0.3, 0.2, 0.3)}, At(-0.15, 0, 0)});
  const MassProperties got = CalcMassProperties(whole, 3.0);
  const MassProperties expected = CalcMassProperties(Box{Vector3(0.4, 0.2, 0.3)}, 3.0);
  EXPECT_NEAR((got.p_BoBcm - Vector3(-0.1, 0, 0)).norm(), 0.0, 1e-15);
  EXPECT_LT((got.I_BBcm - expected.I_BBcm).norm(), 1e-15);
}

TEST(MassPropertiesTest, AUnionOfOverlappingBoxesCountsTheOverlapOnceAndExactly) {
  Union whole;  // four overlapping boxes that fill one
  whole.parts.push_back({Box{Vector3(0.3, 0.2, 0.3)}, At(0.05, 0, 0)});
  whole.parts.push_back({Box{Vector3(0.3, 0.2, 0.3)}, At(-0.05, 0, 0)});
  whole.parts.push_back({Box{Vector3(0.4, 0.2, 0.1)}, At(0, 0, 0.1)});
  whole.parts.push_back({Box{Vector3(0.1, 0.1, 0.1)}, At(0, 0, 0.0)});
  EXPECT_NEAR(CalcVolume(whole), 0.4 * 0.2 * 0.3, 1e-15);
  const MassProperties got = CalcMassProperties(whole, 3.0);
  const MassProperties expected = CalcMassProperties(Box{Vector3(0.4, 0.2, 0.3)}, 3.0);
  EXPECT_LT(got.p_BoBcm.norm(), 1e-14);
  EXPECT_LT((got.I_BBcm - expected.I_BBcm).norm(), 1e-14);
}

TEST(MassPropertiesTest, AUnionOfOverlappingBallsIsTheirLensFormula) {
  const double r = 0.05, d = 0.06;
  Union whole;
  whole.parts.push_back({Sphere{r}, RigidTransform::Identity()});
  whole.parts.push_back({Sphere{r}, At(0.6 * d, 0, 0.8 * d)});
  const double lens = kPi * (4 * r + d) * (2 * r - d) * (2 * r - d) / 12.0;
  const double expected = 8.0 / 3.0 * kPi * r * r * r - lens;
  EXPECT_NEAR(CalcVolume(whole), expected, 2e-4 * expected);
  const MassProperties got = CalcMassProperties(whole, 1.0);
  EXPECT_LT((got.p_BoBcm - Vector3(0.3 * d, 0, 0.4 * d)).norm(), 2e-5);
}

TEST(MassPropertiesTest, APartInsideAnotherAddsNothing) {
  Union whole;
  whole.parts.push_back({Cylinder{0.05, 0.1}, RigidTransform::Identity()});
  const double expected = CalcVolume(whole);
  whole.parts.push_back({Capsule{0.01, 0.03}, At(0.01, 0, 0)});
  EXPECT_NEAR(CalcVolume(whole), expected, 1e-3 * CalcVolume(Capsule{0.01, 0.03}));
}

}  // namespace
}  // namespace pregrasp
