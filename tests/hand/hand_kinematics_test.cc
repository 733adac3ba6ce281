#include "app/hand/hand_kinematics.h"

#include <gtest/gtest.h>

#include "app/hand/hand_simbody.h"
#include "tests/hand/hand_test_data.h"

namespace pregrasp {
namespace {

HandPose PoseOf(const HandConfiguration& configuration) {
  HandPose pose;
  CalcHandPose(ShadowHand(), configuration.X_WH, configuration.q, &pose);
  return pose;
}

// The vendor's tip frames, in the distal links'.
Vector3 VendorTip(int finger) { return {0.0, 0.0, finger == 0 ? 0.0275 : 0.026}; }

// From the vendor's description, joints at zero, palm frame; the little finger's last digit differs
// between descriptions.
TEST(HandKinematicsTest, FingertipFramesAtZeroAreTheVendors) {
  const HandPose pose = PoseOf({});
  const std::array<Vector3, kNumFingers> expected{
      Vector3(0.1029, -0.0086, 0.0979), Vector3(0.033, 0.0, 0.191), Vector3(0.011, 0.0, 0.195),
      Vector3(-0.011, 0.0, 0.191), Vector3(-0.033, 0.0, 0.1826)};
  for (int f = 0; f < kNumFingers; ++f) {
    const Fingertip& tip = ShadowHand().tips[f];
    EXPECT_LT((pose.CalcPoint(tip.link, VendorTip(f)) - expected[f]).norm(), 1e-4)
        << kFingerNames[f];
  }
}

TEST(HandKinematicsTest, PositiveFlexionBringsEveryTipToThePalmarSide) {
  for (int f = 0; f < kNumFingers; ++f) {
    const auto [first, count] = ShadowHand().fingers[f];
    for (const int j : {first + count - 1, first + count - 2}) {
      if (kFingerNames[f] == std::string("thumb") && j == first + count - 2) continue;  // abducts
      HandConfiguration bent;
      bent.q[j] = 0.1;
      const Fingertip& tip = ShadowHand().tips[f];
      const HandPose zero = PoseOf({});
      const Vector3 moved_L =
          zero.R_WL[tip.link].transpose() *
          (PoseOf(bent).CalcPoint(tip.link, VendorTip(f)) - zero.CalcPoint(tip.link, VendorTip(f)));
      EXPECT_LT(moved_L.y(), -0.002) << ShadowHand().joints[j].name;
      EXPECT_LT(std::abs(moved_L.x()), 1e-9) << ShadowHand().joints[j].name;
    }
  }
}

TEST(HandKinematicsTest, PosesAndJacobiansEqualSimbodys) {
  HandSimbody reference(ShadowHand());
  Rng rng(1);
  for (int trial = 0; trial < 100; ++trial) {
    const HandConfiguration configuration = RandomConfiguration(ShadowHand(), rng);
    const HandPose pose = PoseOf(configuration);
    reference.SetConfiguration(configuration);
    for (int link = 0; link < kMaxHandLinks; ++link) {
      const RigidTransform X_WL = reference.CalcLinkPose(link);
      EXPECT_LT((pose.X_WL(link).matrix() - X_WL.matrix()).cwiseAbs().maxCoeff(), 1e-12) << link;
      const Vector3 p_L = 0.03 * rng.Direction();
      PointJacobian J;
      CalcPointJacobian(ShadowHand(), pose, link, pose.CalcPoint(link, p_L), &J);
      EXPECT_LT((J - reference.CalcPointJacobian(link, p_L)).cwiseAbs().maxCoeff(), 1e-12) << link;
    }
  }
}

TEST(HandKinematicsTest, GradientsAreTheDifferenceQuotients) {
  constexpr double kStep = 1e-5;
  Rng rng(2);
  for (int trial = 0; trial < 40; ++trial) {
    const HandConfiguration start = RandomConfiguration(ShadowHand(), rng);
    const HandPose pose = PoseOf(start);
    const int link = static_cast<int>(rng.UniformInt(kMaxHandLinks));
    const Vector3 p_L = 0.03 * rng.Direction();
    const Vector3 d_L = rng.Direction();
    const Vector3 a_W = rng.Direction();
    HandVector point = HandVector::Zero();
    HandVector direction = HandVector::Zero();
    AddPointGradient(ShadowHand(), pose, link, pose.CalcPoint(link, p_L), a_W, &point);
    AddDirectionGradient(ShadowHand(), pose, link, pose.R_WL[link] * d_L, a_W, &direction);
    PointJacobian J;
    CalcPointJacobian(ShadowHand(), pose, link, pose.CalcPoint(link, p_L), &J);
    EXPECT_LT((J.transpose() * a_W - point).cwiseAbs().maxCoeff(), 1e-14);
    for (int i = 0; i < kMaxHandDofs; ++i) {
      const HandVector step = kStep * HandVector::Unit(i);
      const HandPose plus = PoseOf(Advance(start, step));
      const HandPose minus = PoseOf(Advance(start, -step));
      const double point_quotient =
          a_W.dot(plus.CalcPoint(link, p_L) - minus.CalcPoint(link, p_L)) / (2.0 * kStep);
      const double direction_quotient =
          a_W.dot((plus.R_WL[link] - minus.R_WL[link]) * d_L) / (2.0 * kStep);
      EXPECT_NEAR(point[i], point_quotient, 1e-9) << i;
      EXPECT_NEAR(direction[i], direction_quotient, 1e-9) << i;
    }
  }
}

TEST(HandKinematicsTest, CalcStepInvertsAdvance) {
  Rng rng(3);
  for (int trial = 0; trial < 100; ++trial) {
    const HandConfiguration start = RandomConfiguration(ShadowHand(), rng);
    const HandConfiguration end = RandomConfiguration(ShadowHand(), rng);
    const HandConfiguration reached = Advance(start, CalcStep(start, end));
    EXPECT_LT((reached.X_WH.matrix() - end.X_WH.matrix()).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LT((reached.q - end.q).cwiseAbs().maxCoeff(), 1e-12);
  }
}

}  // namespace
}  // namespace pregrasp
