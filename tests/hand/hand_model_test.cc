#include "app/hand/hand_model.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "app/core/error.h"
#include "app/hand/hand_simbody.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

std::string ReadUrdf() {
  std::ifstream in(fs::path(PREGRASP_SOURCE_DIR) / "assets/hands/shadow_right/shadow_right.urdf");
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

// The hand's description with the first `from` replaced by `to`.
fs::path WriteChanged(const std::string& from, const std::string& to) {
  std::string text = ReadUrdf();
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
  const fs::path file =
      fs::temp_directory_path() / ("pregrasp_hand_" + std::to_string(::getpid()) + ".urdf");
  std::ofstream(file) << text;
  return file;
}

void ExpectInputError(const std::string& from, const std::string& to, const std::string& field) {
  const fs::path file = WriteChanged(from, to);
  try {
    LoadHandModel(file);
    ADD_FAILURE() << "no error for " << to;
  } catch (const InputError& error) {
    EXPECT_NE(error.field().find(field), std::string::npos) << error.what();
  }
  fs::remove(file);
}

TEST(HandModelTest, JointsHaveTheVendorsLimitsSpeedsAndEfforts) {
  const HandModel& hand = ShadowHand();
  const auto joint = [&](const std::string& name) {
    for (int j = 0; j < kMaxHandJoints; ++j) {
      if (name == kHandJointNames[j]) return hand.joints[j];
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
    EXPECT_EQ(tip.radius, FingertipRadius(static_cast<Finger>(f)));
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
  const HandJoints q = RelaxedPosture();
  EXPECT_TRUE((q.array() > ShadowHand().q_lower.array()).all());
  EXPECT_TRUE((q.array() < ShadowHand().q_upper.array()).all());
}

TEST(HandModelTest, AWrongDescriptionIsAnInputErrorThatNamesTheField) {
  EXPECT_THROW(LoadHandModel("/nowhere/hand.urdf"), InputError);
  ExpectInputError("<robot", "<rabbit", "");
  ExpectInputError("name=\"FFJ3\" type=\"revolute\"", "name=\"FFJ3\" type=\"continuous\"", "FFJ3");
  ExpectInputError("name=\"FFJ3\"", "name=\"FFJ9\"", "FFJ3");
  ExpectInputError("<cylinder radius=\"0.0097\" length=\"0.041\"/>", "<box size=\"1 1 1\"/>",
                   "ffproximal.collision");
  ExpectInputError("length=\"0.041\"", "length=\"0.05\"", "ffproximal/bone");
  ExpectInputError("0.349066\" upper=\"0.349066", "0.349066\" upper=\"-1", "FFJ4");
}

}  // namespace
}  // namespace pregrasp
