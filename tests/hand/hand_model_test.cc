#include "app/hand/hand_model.h"

#include <gtest/gtest.h>

#include "app/hand/hand_simbody.h"

namespace pregrasp {
namespace {

TEST(HandModelTest, JointsHaveTheVendorsLimitsSpeedsAndEfforts) {
  const HandModel& hand = ShadowHand();
  const auto joint = [&](const std::string& name) {
    for (int j = 0; j < hand.num_joints; ++j) {
      if (name == ShadowHand().joints[j].name) return hand.joints[j];
    }
    throw std::runtime_error(name);
  };
  EXPECT_NEAR(joint("FFJ4").lower, DegToRad(-20), 1e-6);
  EXPECT_NEAR(joint("MFJ3").lower, DegToRad(-15), 1e-6);
  EXPECT_NEAR(joint("RFJ2").upper, DegToRad(90), 1e-6);
  EXPECT_NEAR(joint("LFJ5").upper, DegToRad(45), 1e-6);
  EXPECT_NEAR(joint("THJ5").lower, DegToRad(-60), 1e-6);
  EXPECT_NEAR(joint("THJ4").upper, DegToRad(70), 1e-5);
  EXPECT_NEAR(joint("THJ3").upper, DegToRad(12), 1e-6);
  EXPECT_NEAR(joint("THJ2").lower, DegToRad(-40), 1e-6);
  EXPECT_EQ(joint("THJ5").max_speed, 4.0);
  EXPECT_EQ(joint("THJ2").max_speed, 2.0);
  EXPECT_EQ(joint("THJ5").max_effort, 5.0);
}

TEST(HandModelTest, MassIsTheSumOfTheVendorsLinks) {
  // palm .3, metacarpal .03, four fingers of .008 + .03 + .017 + .012, thumb .091, five tips of
  // .001
  const double expected = 0.3 + 0.03 + 4 * 0.067 + 0.091 + 5 * 0.001;
  double mass = 0.0;
  for (const HandLink& link : ShadowHand().links) mass += link.mass;
  EXPECT_NEAR(mass, expected, 1e-12);
  EXPECT_NEAR(HandSimbody(ShadowHand()).CalcTotalMass(), expected, 1e-12);
}

TEST(HandModelTest, FingertipSpheresAreWhereEveryTestSupposesThem) {
  for (int f = 0; f < kNumFingers; ++f) {
    const Fingertip& tip = ShadowHand().tips[f];
    const double z = f == static_cast<int>(Finger::kThumb) ? 0.024 : 0.0209;
    EXPECT_LT((tip.p_LT - Vector3(0.0, 0.0, z)).norm(), 1e-9);
    EXPECT_EQ(tip.radius, TipSpheres{}.radii[f]);
    EXPECT_EQ(ShadowHand().capsules[tip.capsule].link, tip.link);
  }
}

TEST(HandModelTest, SelfPairsLeaveOutOneLinkAndItsNeighbours) {
  const HandModel& hand = ShadowHand();
  EXPECT_EQ(hand.capsules.size(), 23U);
  const auto has = [&](const std::string& a, const std::string& b) {
    for (const auto& [i, k] : hand.self_pairs) {
      const std::string& x = hand.capsules[i].name;
      const std::string& y = hand.capsules[k].name;
      if ((x == a && y == b) || (x == b && y == a)) return true;
    }
    return false;
  };
  EXPECT_TRUE(has("ffproximal/bone", "mfproximal/bone"));
  EXPECT_TRUE(has("ffproximal/bone", "ffdistal/pad"));
  EXPECT_TRUE(has("thdistal/pad", "palm/index"));
  EXPECT_TRUE(has("thmiddle/bone", "palm/thumb_mount"));
  EXPECT_FALSE(has("ffproximal/bone", "ffmiddle/bone"));
  EXPECT_FALSE(has("palm/index", "ffproximal/bone"));  // connected through the knuckle
  EXPECT_FALSE(has("palm/thumb_mount", "thproximal/bone"));
  EXPECT_FALSE(has("palm/index", "palm/middle"));
}

TEST(HandModelTest, RelaxedPostureIsInsideTheLimits) {
  const HandJoints q = ShadowHand().posture;
  EXPECT_TRUE((q.array() > ShadowHand().q_lower.array()).all());
  EXPECT_TRUE((q.array() < ShadowHand().q_upper.array()).all());
}

}  // namespace
}  // namespace pregrasp
