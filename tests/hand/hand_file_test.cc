#include "app/hand/hand_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "app/hand/hand_measures.h"
#include "app/hand/hand_simbody.h"
#include "tests/hand/hand_test_data.h"
#include "tests/test_folder.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

const fs::path kHands = fs::path(PREGRASP_SOURCE_DIR) / "assets" / "hands";

std::string ReadText(const fs::path& file) {
  std::ifstream in(file);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

// Copies of the four-finger hand's files with one change.
class HandFileTest : public ::testing::Test {
 protected:
  HandFileTest() {
    description_ = ReadText(kHands / "four_finger" / "hand.lua");
    urdf_ = ReadText(kHands / "four_finger" / "four_finger.urdf");
    fs::copy(kHands / "four_finger" / "meshes", folder_.path() / "meshes");
  }

  static void Change(std::string& text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
  }

  HandReading Read(const std::string& description, const std::string& urdf) const {
    std::ofstream(folder_.path() / "hand.lua") << description;
    std::ofstream(folder_.path() / "four_finger.urdf") << urdf;
    return ReadHand(folder_.path() / "hand.lua");
  }

  // All faults, one a line, of the hand with one change.
  std::string FaultsOfDescription(const std::string& from, const std::string& to) const {
    std::string description = description_;
    Change(description, from, to);
    return Lines(Read(description, urdf_));
  }
  std::string FaultsOfUrdf(const std::string& from, const std::string& to) const {
    std::string urdf = urdf_;
    Change(urdf, from, to);
    return Lines(Read(description_, urdf));
  }
  static std::string Lines(const HandReading& reading) {
    std::string lines;
    for (const InputError& fault : reading.faults) lines += std::string(fault.what()) + '\n';
    return lines;
  }

  TestFolder folder_;
  std::string description_, urdf_;
};

TEST_F(HandFileTest, TheShippedHandsHaveNoFaults) {
  EXPECT_EQ(ListHands().size(), 3U);
  for (const auto& [name, file] : ListHands()) {
    const HandReading reading = ReadHand(file);
    EXPECT_EQ(Lines(reading), "") << name;
    EXPECT_EQ(reading.hand.name, name);
  }
  EXPECT_EQ(Lines(Read(description_, urdf_)), "");
}

TEST_F(HandFileTest, ABrokenDescriptionIsNamedInOneLine) {
  using ::testing::HasSubstr;
  EXPECT_THAT(FaultsOfDescription("return hand{", "return hand{{"), HasSubstr("hand.lua:"));
  EXPECT_THAT(FaultsOfDescription("return hand{", "local x = {"), HasSubstr("return hand{ .. }"));
  EXPECT_THAT(FaultsOfDescription("return hand{", "while true do end return hand{"),
              HasSubstr("takes too long"));
  EXPECT_THAT(FaultsOfDescription("return hand{", "return require{"), HasSubstr("nil value"));
  EXPECT_THAT(FaultsOfDescription("palm = ", "plam = "), HasSubstr("did you mean \"palm\"?"));
  EXPECT_THAT(FaultsOfDescription("four_finger.urdf", "five.urdf"), HasSubstr("does not exist"));
  EXPECT_THAT(FaultsOfDescription("four_finger.urdf", "/etc/hostname"),
              HasSubstr("below the description's folder"));
  EXPECT_THAT(FaultsOfDescription("link = \"palm\"", "link = \"plam\""),
              HasSubstr("palm.link: expected a link of the URDF, got \"plam\" (did you mean"));
  EXPECT_THAT(FaultsOfDescription("\"I_PIP\"", "\"I_PPI\""),
              HasSubstr("fingers[2].joints[3]: expected a joint of the URDF, got \"I_PPI\""));
  EXPECT_THAT(FaultsOfDescription("\"I_MCP\", \"I_PIP\"", "\"I_PIP\", \"I_MCP\""),
              HasSubstr("a joint of \"index_knuckle\", the link before it"));
  EXPECT_THAT(FaultsOfDescription("\"T_IP\"", "\"T_MCP\""), HasSubstr("\"T_MCP\" twice"));
  EXPECT_THAT(FaultsOfDescription(", \"T_IP\"}, tip", "}, tip"),
              HasSubstr("T_IP: expected a joint that a finger of the description lists"));
  EXPECT_THAT(FaultsOfDescription("p = {0, 0, 0.027}", "p = {0, 0, 0.008}"),
              HasSubstr("fingers[1].tip: expected a sphere at the finger's end"));
  EXPECT_THAT(FaultsOfDescription("p = {0, 0, 0.027}", "p = {0, 0, 0.070}"),
              HasSubstr("mm off its collision shapes"));
  EXPECT_THAT(FaultsOfDescription("r = 0.0125", "r = 12.5"),
              HasSubstr("fingers[1].tip.r: expected a number from 0.001 to 0.1 m, got 12.5"));
  EXPECT_THAT(FaultsOfDescription("I_MCP = 0.30", "I_MCP = 3.0"),
              HasSubstr("posture.I_MCP: expected an angle from -0.3 to 1.65 rad, got 3"));
  EXPECT_THAT(FaultsOfDescription("I_ABD = -0.05", "I_ABD = 0.40"),
              HasSubstr("one in which no part of the hand overlaps another"));
  EXPECT_THAT(
      FaultsOfDescription("posture = {", "may_touch = {{\"palm\", \"tumb\"}},\nposture = {"),
      HasSubstr("may_touch[1]: expected the palm or a link that a joint moves"));
  EXPECT_THAT(FaultsOfDescription("fingers = {", "fingers = {}, extra = {"),
              HasSubstr("extra: expected a key of this table"));
}

TEST_F(HandFileTest, AUrdfThatIsNoHandIsNamedInOneLine) {
  using ::testing::HasSubstr;
  EXPECT_THAT(FaultsOfUrdf("<robot", "<rabbit"), HasSubstr("a valid URDF description"));
  EXPECT_THAT(
      FaultsOfUrdf("name=\"I_PIP\" type=\"revolute\"", "name=\"I_PIP\" type=\"continuous\""),
      HasSubstr("I_PIP: expected a revolute joint with limits, got a continuous one"));
  EXPECT_THAT(FaultsOfUrdf("name=\"I_DIP\" type=\"revolute\">",
                           "name=\"I_DIP\" type=\"revolute\"><mimic joint=\"I_PIP\"/>"),
              HasSubstr("I_DIP: expected a joint that is driven by itself, got one that follows"));
  EXPECT_THAT(FaultsOfUrdf("lower=\"-0.4\" upper=\"0.4\"", "lower=\"0.4\" upper=\"-0.4\""),
              HasSubstr("I_ABD: expected limits lower < upper in radians"));
  EXPECT_THAT(FaultsOfUrdf("velocity=\"3\"", "velocity=\"0\""),
              HasSubstr("I_ABD: expected a limit of velocity above 0 rad/s"));
  EXPECT_THAT(FaultsOfUrdf("<axis xyz=\"0 -1 0\"/>", "<axis xyz=\"0 -2 0\"/>"),
              HasSubstr("I_ABD: expected an axis of length 1, got 2"));
  EXPECT_THAT(
      FaultsOfUrdf("<mass value=\"0.042\"/>", "<mass value=\"0\"/>"),
      HasSubstr("index_proximal.inertial: expected a mass above 0 and at most 100 kg, got 0"));
  EXPECT_THAT(
      FaultsOfUrdf("ixx=\"1.5e-05\"", "ixx=\"5e-03\""),
      HasSubstr("index_proximal.inertial: expected moments of inertia that a body can have"));
  EXPECT_THAT(
      FaultsOfUrdf("<cylinder radius=\"0.0112\" length=\"0.045\"/>", "<box size=\"1 1 1\"/>"),
      HasSubstr("index_proximal.collision: expected cylinders and spheres, got a box"));
  EXPECT_THAT(FaultsOfUrdf("<mesh filename=\"meshes/palm.obj\"/>", "<mesh filename=\"palm.obj\"/>"),
              HasSubstr("palm.visual: expected a file"));
  const std::string tip =
      "    <collision name=\"bone\"><origin xyz=\"0 0 0.015\"/><geometry>"
      "<cylinder radius=\"0.0125\" length=\"0.024\"/></geometry></collision>\n";
  EXPECT_THAT(
      FaultsOfUrdf(tip, ""),
      HasSubstr("thumb_distal.collision: expected the shape of the finger's last link, got none"));
  EXPECT_THAT(FaultsOfUrdf("<cylinder radius=\"0.0112\"", "<cylinder radius=\"nan\""),
              HasSubstr("expected a URDF that is read whole"));
  EXPECT_THAT(FaultsOfUrdf("<mass value=\"0.042\"/>", "<mass value=\"1e300\"/>"),
              HasSubstr("index_proximal.inertial: expected a mass above 0 and at most 100 kg"));
  std::string deep;
  for (int i = 0; i < 2000; ++i) deep += "<a>";
  EXPECT_THAT(FaultsOfUrdf("<link name=\"palm\">", deep), HasSubstr("10000 elements, 100 deep"));
  std::string chain;
  for (int i = 0; i < 20000; ++i) {
    chain += fmt::format(
        "<link name=\"l{0}\"/><joint name=\"j{0}\" type=\"fixed\">"
        "<parent link=\"{1}\"/><child link=\"l{0}\"/></joint>",
        i, i == 0 ? "palm" : fmt::format("l{}", i - 1));
  }
  EXPECT_THAT(FaultsOfUrdf("</robot>", chain + "</robot>"), HasSubstr("10000 elements"));
  const std::string circle =
      "<link name=\"world\"/><link name=\"wrist\"/>"
      "<joint name=\"a\" type=\"fixed\"><parent link=\"wrist\"/><child link=\"palm\"/></joint>"
      "<joint name=\"b\" type=\"fixed\"><parent link=\"palm\"/><child link=\"wrist\"/></joint>";
  EXPECT_THAT(FaultsOfUrdf("</robot>", circle + "</robot>"),
              HasSubstr("a link of one tree, got one whose parents go round in a circle"));
}

TEST_F(HandFileTest, SeveralFaultsAreSaidAtOnce) {
  std::string urdf = urdf_;
  Change(urdf, "<mass value=\"0.042\"/>", "<mass value=\"0\"/>");
  Change(urdf, "<axis xyz=\"0 -1 0\"/>", "<axis xyz=\"0 -1 0\"/>");
  Change(urdf, "<cylinder radius=\"0.0138\" length=\"0.04\"/>", "<box size=\"1 1 1\"/>");
  EXPECT_EQ(Read(description_, urdf).faults.size(), 2U);
}

TEST_F(HandFileTest, CapsulesOfTheDescriptionTakeThePlaceOfTheUrdfs) {
  std::string urdf = urdf_, description = description_;
  Change(urdf, "<cylinder radius=\"0.0138\" length=\"0.04\"/>", "<box size=\"0.03 0.03 0.05\"/>");
  Change(description, "posture = {",
         "capsules = {thumb_proximal = {{from = {0, 0, 0.004}, to = {0, 0, 0.044}, r = 0.0138}}},\n"
         "posture = {");
  const HandReading reading = Read(description, urdf);
  EXPECT_EQ(Lines(reading), "");
  const HandModel& shipped = FindHand("four_finger");
  ASSERT_EQ(reading.hand.capsules.size(), shipped.capsules.size());
  for (std::size_t i = 0; i < shipped.capsules.size(); ++i) {
    EXPECT_LT((reading.hand.capsules[i].p_LB - shipped.capsules[i].p_LB).norm(), 1e-9) << i;
    EXPECT_NEAR(reading.hand.capsules[i].radius, shipped.capsules[i].radius, 1e-12) << i;
  }
}

// Two fingers, whose last links' frames and palm are turned by R from ours; X_UL is ours in theirs.
std::string TurnedUrdf(const Matrix3& R_UL) {
  const auto text = [](const Vector3& v) {
    return fmt::format("\"{:.12g} {:.12g} {:.12g}\"", v.x(), v.y(), v.z());
  };
  const Vector3 rpy_UL(std::atan2(R_UL(2, 1), R_UL(2, 2)), -std::asin(R_UL(2, 0)),
                       std::atan2(R_UL(1, 0), R_UL(0, 0)));
  std::string out =
      "<robot name=\"two\"><link name=\"base\">"
      "<inertial><mass value=\"0.2\"/><inertia ixx=\"1e-4\" ixy=\"0\" ixz=\"0\" "
      "iyy=\"1e-4\" iyz=\"0\" izz=\"1e-4\"/></inertial></link>";
  for (const auto& [name, x] : {std::pair{"a", 0.03}, std::pair{"b", -0.03}}) {
    // The joint's frame is ours turned by R_LU about its origin, seen from the palm turned by R_UL.
    out += fmt::format(
        "<joint name=\"{0}\" type=\"revolute\"><parent link=\"base\"/><child link=\"{0}_link\"/>"
        "<origin xyz={1} rpy=\"0 0 0\"/><axis xyz={2}/>"
        "<limit lower=\"-1\" upper=\"1.5\" effort=\"1\" velocity=\"2\"/></joint>"
        "<link name=\"{0}_link\"><inertial><origin xyz={3}/><mass value=\"0.03\"/>"
        "<inertia ixx=\"1e-5\" ixy=\"0\" ixz=\"0\" iyy=\"1e-5\" iyz=\"0\" izz=\"1e-5\"/></inertial>"
        "<collision><origin xyz={3} rpy={4}/><geometry><cylinder radius=\"0.01\" length=\"0.06\"/>"
        "</geometry></collision></link>",
        name, text(R_UL * Vector3(x, 0.0, 0.1)), text(R_UL * Vector3::UnitX()),
        text(R_UL * Vector3(0.0, 0.0, 0.03)), text(rpy_UL));
  }
  return out + "</robot>";
}

std::string TurnedDescription(const Matrix3& R_UL) {
  const auto text = [](const Vector3& v) {
    return fmt::format("{{{:.12g}, {:.12g}, {:.12g}}}", v.x(), v.y(), v.z());
  };
  const std::string frame =
      fmt::format("along = {}, palmar = {}", text(R_UL.col(2)), text(-R_UL.col(1)));
  const std::string tip =
      fmt::format("tip = {{p = {}, r = 0.01, {}}}", text(R_UL * Vector3(0.0, 0.0, 0.06)), frame);
  return fmt::format(
      "return hand{{name = \"two\", urdf = \"four_finger.urdf\", palm = {{link = \"base\", {}}},"
      "fingers = {{{{joints = {{\"a\"}}, {}}}, {{joints = {{{{urdf = \"b\", name = \"bend\"}}}}, "
      "{}}}}}}}",
      frame, tip, tip);
}

TEST_F(HandFileTest, FramesThatLieOtherwiseAreTurnedToOurs) {
  const Matrix3 R_UL = RotationFromRpy({0.7, -0.4, 1.9});
  const HandReading ours =
      Read(TurnedDescription(Matrix3::Identity()), TurnedUrdf(Matrix3::Identity()));
  const HandReading theirs = Read(TurnedDescription(R_UL), TurnedUrdf(R_UL));
  ASSERT_EQ(Lines(ours), "");
  ASSERT_EQ(Lines(theirs), "");
  EXPECT_EQ(theirs.hand.joints[0].name, "bend");  // the thumb's joint comes last
  EXPECT_EQ(theirs.hand.num_fingers, 2);
  HandConfiguration at;
  at.q[0] = 0.4;
  at.q[1] = -0.2;
  HandPose pose, turned;
  CalcHandPose(ours.hand, at.X_WH, at.q, &pose);
  CalcHandPose(theirs.hand, at.X_WH, at.q, &turned);
  for (int link = 0; link < 3; ++link) {
    EXPECT_LT((pose.X_WL(link).matrix() - turned.X_WL(link).matrix()).cwiseAbs().maxCoeff(), 1e-9);
  }
  for (int i = 0; i < 2; ++i) {
    EXPECT_LT((ours.hand.capsules[i].p_LB - theirs.hand.capsules[i].p_LB).norm(), 1e-9);
    EXPECT_LT((ours.hand.links[i + 1].p_LoLcm - theirs.hand.links[i + 1].p_LoLcm).norm(), 1e-9);
  }
}

TEST(MirroredHandTest, TheLeftHandIsTheRightInAMirror) {
  const HandModel& right = FindHand("shadow_right");
  const HandModel& left = FindHand("shadow_left");
  const Matrix3 S = Vector3(-1.0, 1.0, 1.0).asDiagonal();
  Rng rng(1);
  for (int trial = 0; trial < 20; ++trial) {
    const HandConfiguration at = RandomConfiguration(right, rng);
    HandPose pose, mirrored;
    CalcHandPose(right, RigidTransform::Identity(), at.q, &pose);
    CalcHandPose(left, RigidTransform::Identity(), at.q, &mirrored);
    for (int link = 0; link < right.num_links(); ++link) {
      EXPECT_LT((S * pose.p_WL[link] - mirrored.p_WL[link]).norm(), 1e-12);
      EXPECT_LT((S * pose.R_WL[link] * S - mirrored.R_WL[link]).norm(), 1e-12);
    }
    for (std::size_t i = 0; i < right.capsules.size(); ++i) {
      const HandCapsule &a = right.capsules[i], &b = left.capsules[i];
      EXPECT_LT((S * pose.CalcPoint(a.link, a.p_LB) - mirrored.CalcPoint(b.link, b.p_LB)).norm(),
                1e-12);
    }
  }
  EXPECT_EQ(HandSimbody(left).CalcTotalMass(), HandSimbody(right).CalcTotalMass());
}

class AnyHandTest : public ::testing::TestWithParam<const char*> {};

TEST_P(AnyHandTest, PosesAndJacobiansEqualSimbodys) {
  const HandModel& hand = FindHand(GetParam());
  HandSimbody reference(hand);
  Rng rng(1);
  for (int trial = 0; trial < 20; ++trial) {
    const HandConfiguration at = RandomConfiguration(hand, rng);
    HandPose pose;
    CalcHandPose(hand, at.X_WH, at.q, &pose);
    reference.SetConfiguration(at);
    for (int link = 0; link < hand.num_links(); ++link) {
      const RigidTransform X_WL = reference.CalcLinkPose(link);
      EXPECT_LT((pose.X_WL(link).matrix() - X_WL.matrix()).cwiseAbs().maxCoeff(), 1e-12) << link;
      PointJacobian J;
      CalcPointJacobian(hand, pose, link, pose.CalcPoint(link, {0.01, 0.02, 0.03}), &J);
      const PointJacobian expected = reference.CalcPointJacobian(link, {0.01, 0.02, 0.03});
      EXPECT_LT((J - expected).cwiseAbs().maxCoeff(), 1e-12) << link;
    }
  }
}

TEST_P(AnyHandTest, TheThumbMeetsEveryFinger) {
  const HandModel& hand = FindHand(GetParam());
  const HandMeasures measures = MeasureHand(hand);
  for (int f = 1; f < hand.num_fingers; ++f) {
    EXPECT_LT(measures.nearest[f], kMeeting) << kFingerNames[f];
    EXPECT_GT(measures.farthest[f], 0.15) << kFingerNames[f];
    HandPose pose;
    CalcHandPose(hand, RigidTransform::Identity(), measures.meeting[f], &pose);
    const auto tip = [&](int finger) {
      return pose.CalcPoint(hand.tips[finger].link, hand.tips[finger].p_LT);
    };
    const double gap = (tip(0) - tip(f)).norm() - hand.tips[0].radius - hand.tips[f].radius;
    EXPECT_LT(std::abs(gap), kMeeting) << kFingerNames[f];
  }
}

INSTANTIATE_TEST_SUITE_P(Hands, AnyHandTest, ::testing::Values("shadow_left", "four_finger"));

}  // namespace
}  // namespace pregrasp
