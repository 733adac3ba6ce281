#include "app/motion/smooth_motion.h"

#include <gtest/gtest.h>

#include "app/hand/hand_kinematics.h"

namespace pregrasp {
namespace {

RigidTransform Standing(const Vector3& p) { return MakeTransform(Quaternion::Identity(), p); }

class SmoothMotionTest : public ::testing::Test {
 protected:
  static constexpr int kFrames = 41;

  // Each frame near where it is; the last one with the index fingertip on a contact.
  std::vector<HandDemand> Demands(const std::vector<HandConfiguration>& motion) const {
    std::vector<HandDemand> demands(motion.size());
    for (HandDemand& demand : demands) {
      demand.problem.X_WB = X_WB_;
      demand.problem.reference = motion.back();
      demand.problem.reference_weight = 0.0;
      demand.config.clearance_buffer = 1e-3;
    }
    return demands;
  }

  SmoothingResult Smooth(std::vector<HandDemand> demands,
                         std::vector<HandConfiguration>* motion) const {
    std::vector<HandDemand> ways = Demands(*motion);
    ways.pop_back();
    return SmoothMotion(solver_, demands, ways, {}, 30.0, {}, motion);
  }

  // From one side to the other, jerkily.
  std::vector<HandConfiguration> Zigzag() const {
    std::vector<HandConfiguration> motion(kFrames);
    for (int i = 0; i < kFrames; ++i) {
      motion[i].q = ShadowHand().posture;
      motion[i].q[2] += i % 2 == 0 ? 0.0 : 0.1;
      motion[i].X_WH.translation() << 0.3 * i / (kFrames - 1.0), i % 2 == 0 ? 0.0 : 0.01, 0.0;
    }
    return motion;
  }

  bool IsClear(const std::vector<HandConfiguration>& motion) const {
    for (std::size_t i = 1; i < motion.size(); ++i) {
      HandWay way;
      way.from = motion[i - 1];
      way.to = motion[i];
      way.X_WB = {X_WB_};
      if (!solver_.CheckWay(way).clear) return false;
    }
    return true;
  }

  static IkContact ContactOf(const HandConfiguration& hand) {
    HandPose pose;
    CalcHandPose(ShadowHand(), hand.X_WH, hand.q, &pose);
    const Fingertip& tip = ShadowHand().tip(Finger::kIndex);
    const Vector3 nhat_W = -pose.R_WL[tip.link].col(2);
    return {Finger::kIndex, pose.CalcPoint(tip.link, tip.p_LT) - tip.radius * nhat_W, nhat_W};
  }

  const Shape ball_{Sphere{0.03}}, post_{Capsule{0.005, 0.02}};
  std::vector<RigidTransform> X_WB_{Standing({0.0, 0.0, 3.0}), Standing({0.0, 3.0, 0.0})};
  const IkSolver solver_{ShadowHand(), std::vector<const Shape*>{&ball_, &post_}};
};

TEST_F(SmoothMotionTest, AJerkyMotionComesToKeepTheLimitsAndItsContact) {
  std::vector<HandConfiguration> motion = Zigzag();
  std::vector<HandDemand> demands = Demands(motion);
  demands.back().problem.contacts = {ContactOf(motion.back())};
  const HandConfiguration first = motion.front();
  const SmoothingResult result = Smooth(demands, &motion);
  EXPECT_LT(result.cost_after, 0.1 * result.cost_before);
  EXPECT_EQ(motion.front().q, first.q);
  EXPECT_EQ(motion.front().X_WH.matrix(), first.X_WH.matrix());
  for (int i = 0; i < kFrames; ++i) {
    EXPECT_TRUE(CalcRates(ShadowHand(), {}, motion, i, 30.0).IsWithinLimits()) << i;
  }
  const IkResult end = solver_.Evaluate({}, demands.back().problem, motion.back());
  EXPECT_TRUE(end.solved());
  EXPECT_LT(end.tip_error, 2e-4);
}

TEST_F(SmoothMotionTest, WhatStandsInTheWayIsGoneRoundBetweenTheFramesToo) {
  // A small post a little off the way of the fingertips, which would come to overlap with it.
  std::vector<HandConfiguration> motion = Zigzag();
  HandPose pose;
  CalcHandPose(ShadowHand(), motion[20].X_WH, motion[20].q, &pose);
  const Fingertip& tip = ShadowHand().tip(Finger::kMiddle);
  X_WB_[1] = Standing(pose.CalcPoint(tip.link, tip.p_LT) + Vector3(0.0, 0.0, 0.018));
  std::vector<HandDemand> demands = Demands(motion);
  demands.back().problem.contacts = {ContactOf(motion.back())};
  EXPECT_FALSE(IsClear(motion));
  Smooth(demands, &motion);
  EXPECT_TRUE(IsClear(motion));
}

TEST_F(SmoothMotionTest, AStillMotionStays) {
  std::vector<HandConfiguration> motion(8);
  for (HandConfiguration& hand : motion) hand.q = ShadowHand().posture;
  Smooth(Demands(motion), &motion);
  for (const HandConfiguration& hand : motion) {
    EXPECT_TRUE(hand.q.isApprox(ShadowHand().posture, 1e-9));
    EXPECT_TRUE(hand.X_WH.isApprox(RigidTransform::Identity(), 1e-9));
  }
}

}  // namespace
}  // namespace pregrasp
