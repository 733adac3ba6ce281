#include "app/hand/way.h"

#include <gtest/gtest.h>

#include "app/core/rng.h"
#include "app/hand/ik.h"

namespace pregrasp {
namespace {

HandConfiguration HandAt(const Vector3& p_WH) {
  HandConfiguration hand;
  hand.X_WH.translation() = p_WH;
  hand.q = ShadowHand().posture;
  return hand;
}

class WayTest : public ::testing::Test {
 protected:
  WayTest() : plate_(Box{{0.001, 0.4, 0.4}}), ball_(Sphere{0.03}) {}

  // Ball and plate, the ball far away.
  HandWay Way(const HandConfiguration& from, const HandConfiguration& to) const {
    HandWay way;
    way.from = from;
    way.to = to;
    way.X_WB = {{At({0.0, 0.0, 3.0}), At({0.0, 0.0, 0.0})}};
    return way;
  }

  static RigidTransform At(const Vector3& p) { return MakeTransform(Quaternion::Identity(), p); }

  // The least room over many moments of a way: of all pairs, beyond what is allowed.
  double SampleLeast(const HandWay& way) const {
    const HandObstacles obstacles({&ball_, &plate_});
    double least = 1.0;
    constexpr int kPoints = 400;
    for (int i = 0; i <= kPoints; ++i) {
      const double s = static_cast<double>(i) / kPoints;
      const HandConfiguration at = Advance(way.from, HandVector(s * CalcStep(way.from, way.to)));
      HandPose pose;
      CalcHandPose(ShadowHand(), at.X_WH, at.q, &pose);
      CapsuleEnds ends;
      CalcCapsuleEnds(ShadowHand(), pose, &ends);
      std::vector<HandDistance> near;
      FindNearSelf(ShadowHand(), ends, 1.0, &near);
      std::vector<RigidTransform> X_WB = way.X_WB.front();
      for (std::size_t b = 0; b < X_WB.size(); ++b) {
        X_WB[b].translation() += s * (way.X_WB.back()[b].translation() - X_WB[b].translation());
      }
      obstacles.FindNear(ShadowHand(), ends, obstacles.Place(X_WB), way.touch, 1.0, &near);
      for (const HandDistance& pair : near) {
        least = std::min(least, pair.distance + (pair.touch ? way.touch.depth : 0.0));
      }
    }
    return least;
  }

  const Shape plate_, ball_;
  const IkSolver solver_{ShadowHand(), std::vector<const Shape*>{&ball_, &plate_}};
};

TEST_F(WayTest, AWayThroughAThinPlateIsBlockedThoughBothItsEndsAreFree) {
  const WayResult through = solver_.CheckWay(Way(HandAt({-0.3, 0, 0}), HandAt({0.3, 0, 0})));
  EXPECT_FALSE(through.clear);
  ASSERT_TRUE(through.worst.has_value());
  EXPECT_EQ(through.worst->pair, HandPair::kEnvironment);
  EXPECT_EQ(through.worst->other, 1);
  EXPECT_LT(through.worst->distance, 0.0);
  EXPECT_NEAR(through.s, 0.5, 0.2);
  EXPECT_TRUE(solver_.CheckWay(Way(HandAt({-0.3, 0, 0}), HandAt({-0.2, 0.2, 0}))).clear);
}

TEST_F(WayTest, ABodyThatComesIntoAStandingHandBlocksTheWay) {
  HandWay way = Way(HandAt({-0.3, 0, 0}), HandAt({-0.3, 0, 0}));
  way.X_WB = {{At({-0.3, -0.5, 0.05}), At(Vector3::Zero())},
              {At({-0.3, 0.5, 0.05}), At(Vector3::Zero())}};
  EXPECT_FALSE(solver_.CheckWay(way).clear);
  way.X_WB = {{At({-0.3, -0.5, 0.4}), At(Vector3::Zero())},
              {At({-0.3, 0.5, 0.4}), At(Vector3::Zero())}};
  EXPECT_TRUE(solver_.CheckWay(way).clear);
  // Round it in three pieces: only the poses in between tell.
  way.X_WB = {{At({-0.3, -0.5, 0.4}), At(Vector3::Zero())},
              {At({-0.3, 0.0, 0.1}), At(Vector3::Zero())},
              {At({-0.3, 0.5, 0.4}), At(Vector3::Zero())}};
  EXPECT_FALSE(solver_.CheckWay(way).clear);
}

TEST_F(WayTest, FingersThatFoldIntoEachOtherBlockTheWay) {
  HandConfiguration from = HandAt({-0.3, 0, 0}), to = from;
  to.q[0] = -0.34;  // the index finger and the middle finger, towards each other and past
  to.q[4] = 0.34;
  std::swap(from.q[0], from.q[4]);
  const HandWay way = Way(from, to);
  EXPECT_EQ(solver_.CheckWay(way).clear, SampleLeast(way) > 0.0);
}

TEST_F(WayTest, AHandThatCarriesTheObjectIsNotInItsWay) {
  // The index fingertip on the ball's top, a tenth of a millimetre off; both turn a little, as from
  // one physics step to the next, where the two ways of interpolating differ by micrometres.
  HandConfiguration from = HandAt({-0.3, 0, 0});
  HandPose pose;
  CalcHandPose(ShadowHand(), from.X_WH, from.q, &pose);
  const Fingertip& tip = ShadowHand().tip(Finger::kIndex);
  const Vector3 p_WT = pose.CalcPoint(tip.link, tip.p_LT);
  const Vector3 away = pose.R_WL[tip.link].col(2);
  const RigidTransform X_WO = At(p_WT + (tip.radius + 0.03 + 1e-4) * away);
  RigidTransform turn = RigidTransform::Identity();
  turn.linear() = Eigen::AngleAxisd(0.01, Vector3(1.0, 2.0, 2.0) / 3.0).toRotationMatrix();
  turn.translation() << 0.0, 0.01, 0.005;
  HandWay way = Way(from, from);
  way.to.X_WH = turn * from.X_WH;
  way.X_WB = {{X_WO, At(Vector3::Zero())}, {turn * X_WO, At(Vector3::Zero())}};
  const WayResult carried = solver_.CheckWay(way);
  EXPECT_TRUE(carried.clear);
  EXPECT_LE(carried.evaluations, 64);
  // A ball that does not go along meets the hand.
  way.X_WB.front()[0] = X_WO;
  way.X_WB.back()[0] = At(X_WO.translation() - 0.02 * away);
  EXPECT_FALSE(solver_.CheckWay(way).clear);
}

TEST_F(WayTest, WhatIsCalledClearIsClearAtEveryMomentAndWhatIsBlockedIsNot) {
  int clear = 0, blocked = 0;
  for (int i = 0; i < 60; ++i) {
    Rng rng(11, RngStream::kTest, i);
    const auto sample = [&] {
      HandConfiguration hand;
      hand.X_WH = MakeTransform(rng.Rotation(),
                                Vector3(rng.Uniform(-0.25, -0.05), rng.Uniform(-0.2, 0.2), 0.0));
      for (int j = 0; j < kMaxHandJoints; ++j) {
        const double upper = ShadowHand().q_upper[j];
        hand.q[j] = ShadowHand().q_lower[j] < -0.01 ? 0.0 : rng.Uniform(0.0, 0.6 * upper);
      }
      return hand;
    };
    HandConfiguration from = sample(), to = sample();
    to.X_WH.linear() = Eigen::AngleAxisd(0.4, rng.Direction()) * from.X_WH.linear();
    HandWay way = Way(from, to);
    way.X_WB = {{At({-0.1, 0.3, 0.1}), At(Vector3::Zero())},
                {At({-0.1, 0.1, 0.1}), At(Vector3::Zero())}};
    way.touch.touching[1] = true;
    const WayResult result = solver_.CheckWay(way);
    const double least = SampleLeast(way);
    if (result.clear) {
      ++clear;
      EXPECT_GE(least, -kWayResolution) << i;
    } else {
      ++blocked;
      ASSERT_TRUE(result.worst.has_value());
      EXPECT_LT(result.worst->distance, 0.0) << i;
    }
    if (least < -kWayResolution) {
      EXPECT_FALSE(result.clear) << i;
    }
  }
  EXPECT_GE(clear, 5);
  EXPECT_GE(blocked, 5);
}

TEST(HandReachTest, NoPointOfACapsuleIsFartherOrGoesFartherThanItsBound) {
  const HandModel& hand = ShadowHand();
  const HandReach reach(hand);
  for (int n = 0; n < 200; ++n) {
    Rng rng(12, RngStream::kTest, n);
    HandJoints q, dq;
    for (int j = 0; j < kMaxHandJoints; ++j) {
      q[j] = rng.Uniform(hand.q_lower[j], hand.q_upper[j]);
      dq[j] = rng.Uniform(-0.2, 0.2);
    }
    HandPose before, after;
    CalcHandPose(hand, RigidTransform::Identity(), q, &before);
    CalcHandPose(hand, RigidTransform::Identity(), q + dq, &after);
    for (std::size_t i = 0; i < hand.capsules.size(); ++i) {
      const HandCapsule& capsule = hand.capsules[i];
      const int index = static_cast<int>(i);
      for (const Vector3& p_L : {capsule.p_LA, capsule.p_LB}) {
        const Vector3 a = before.CalcPoint(capsule.link, p_L);
        EXPECT_LE(a.norm(), reach.FromPalm(index) + 1e-12);
        EXPECT_LE((after.CalcPoint(capsule.link, p_L) - a).norm(),
                  reach.CalcTravel(hand, index, dq) + 1e-12);
      }
    }
  }
}

}  // namespace
}  // namespace pregrasp
