// Hands other than the Shadow Hand: `pregrasp hand check`, and a run planned, drawn and recomputed
// with one (docs/your_own_hand.md).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "tests/bindings/run_program.h"
#include "tests/test_folder.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

const fs::path kSource = PREGRASP_SOURCE_DIR;
const fs::path kOwnHand = kSource / "docs" / "your_own_hand";

std::string ReadText(const fs::path& file) {
  std::ifstream in(file);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

TEST(HandCommandTest, MeasuresAHandAndDrawsTenPoses) {
  const TestFolder folder;
  const ProgramResult shipped = RunProgram({"hand", "check", "four_finger"}, folder.path());
  EXPECT_EQ(shipped.code, 0) << shipped.err;
  EXPECT_EQ(shipped.out.find("four_finger: 4 fingers, 16 joints, "), 0U) << shipped.out;
  EXPECT_THAT(shipped.out, HasSubstr("tip of 12.5 mm"));
  int pictures = 0;
  for (const auto& entry : fs::directory_iterator(folder.path() / "out" / "hand_four_finger")) {
    EXPECT_GT(entry.file_size(), 20'000U) << entry.path();
    ++pictures;
  }
  EXPECT_EQ(pictures, 10);
}

TEST(HandCommandTest, SaysEachFaultInALineAndDrawsNothing) {
  const TestFolder folder;
  fs::copy(kOwnHand, folder.path() / "own");
  std::string text = ReadText(kOwnHand / "hand.lua");
  const std::string bars = "palm_link = {bar";
  text.replace(text.find(bars), bars.size(), "[\"link_13.0\"] = {bar");
  std::ofstream(folder.path() / "own" / "hand.lua") << text;
  const ProgramResult broken = RunProgram({"hand", "check", "own/hand.lua"}, folder.path());
  EXPECT_EQ(broken.code, 2);
  EXPECT_EQ(broken.out, "");
  EXPECT_THAT(broken.err, HasSubstr("allegro.urdf: palm_link.collision: expected cylinders and "
                                    "spheres, got a box: say capsules = "));
  EXPECT_FALSE(fs::exists(folder.path() / "out"));
  const std::string expected =
      "hand: expected the name of a hand (four_finger, shadow_left, shadow_right) or a hand.lua, "
      "got \"for_finger\" (did you mean \"four_finger\"?)\n";
  const ProgramResult mistyped = RunProgram({"hand", "check", "for_finger"}, folder.path());
  EXPECT_EQ(mistyped.code, 2);
  EXPECT_EQ(mistyped.err, expected);
  EXPECT_EQ(RunProgram({"hand", "check", "own"}, folder.path()).code, 2);
  EXPECT_EQ(RunProgram({"hand", "check", "./own"}, folder.path()).err,
            "./own: expected a hand.lua, got a folder\n");
  const ProgramResult run =
      RunProgram({"run", (kSource / "scenes" / "ruler.lua").string(), "--set", "hand=for_finger"},
                 folder.path());
  EXPECT_EQ(run.code, 2);
  EXPECT_EQ(run.err, "--set: " + expected);
  const ProgramResult pipe =
      RunProgram({"run", (kSource / "scenes" / "ruler.lua").string(), "--set", "hand=/dev/null"},
                 folder.path());
  EXPECT_EQ(pipe.err, "--set: hand \"/dev/null\": expected a file, got a device\n");
}

TEST(HandCommandTest, AThumbThatMeetsNoFingerIsAFault) {
  const TestFolder folder;
  fs::copy(kOwnHand, folder.path() / "own");
  std::string urdf = ReadText(kOwnHand / "allegro.urdf");
  const std::string limits = "lower=\"0.263\" upper=\"1.396\"";
  const std::string turn = "lower=\"-0.105\" upper=\"1.163\"";
  urdf.replace(urdf.find(limits), limits.size(), "lower=\"0.263\" upper=\"0.3\"");
  urdf.replace(urdf.find(turn), turn.size(), "lower=\"-0.105\" upper=\"-0.1\"");
  std::ofstream(folder.path() / "own" / "allegro.urdf") << urdf;
  std::string text = ReadText(kOwnHand / "hand.lua");
  const std::string posture = "[\"joint_12.0\"] = 0.9, [\"joint_13.0\"] = 0.3";
  text.replace(text.find(posture), posture.size(), "[\"joint_12.0\"] = 0.28");
  std::ofstream(folder.path() / "own" / "hand.lua") << text;
  const ProgramResult apart = RunProgram({"hand", "check", "own/hand.lua"}, folder.path());
  EXPECT_EQ(apart.code, 2) << apart.out;
  EXPECT_THAT(apart.err, HasSubstr("fingers[4]: expected a finger that the thumb can meet, got "
                                   "tips that stay "));
}

TEST(HandCommandTest, TheDocumentsExampleIsTheFileThatIsShipped) {
  EXPECT_THAT(ReadText(kSource / "docs" / "your_own_hand.md"),
              HasSubstr(ReadText(kOwnHand / "hand.lua")));
}

// The run holds what it takes to draw it and to recompute it elsewhere.
TEST(HandCommandTest, ARunWithAHandOfOnesOwnKeepsIt) {
  const TestFolder folder;
  fs::copy(kOwnHand, folder.path() / "own");
  const ProgramResult run =
      RunProgram({"run", (kSource / "scenes" / "ruler.lua").string(), "--set", "hand=own/hand.lua",
                  "--seed", "3", "--pictures", "none", "--out", "run"},
                 folder.path());
  ASSERT_EQ(run.code, 0) << run.err;
  fs::remove_all(folder.path() / "own");
  const fs::path directory = folder.path() / "run";
  const auto scene = nlohmann::json::parse(ReadText(directory / "scene.json"));
  EXPECT_EQ(scene["hand"]["name"], "hand/hand.lua");
  EXPECT_EQ(scene["hand"]["joints"].size(), 16U);
  EXPECT_EQ(scene["hand"]["joints"][0], "joint_0.0");
  EXPECT_EQ(scene["hand"]["joints"][15], "joint_15.0");  // the thumb's come last
  EXPECT_TRUE(fs::exists(directory / "hand" / "allegro.urdf"));
  const std::string motion = ReadText(directory / "motion.csv"),
                    lift = ReadText(directory / "lift.csv");
  EXPECT_THAT(motion.substr(0, motion.find('\n')), HasSubstr(",joint_0.0,joint_1.0,"));
  EXPECT_THAT(motion.substr(0, motion.find('\n')), HasSubstr(",ring_on,phase,"));
  EXPECT_THAT(lift.substr(0, lift.find('\n')), HasSubstr(",ring_b"));
  EXPECT_EQ(lift.substr(0, lift.find('\n')).find("little"), std::string::npos);
  EXPECT_EQ(RunProgram({"show", "run", "--out", "last.png"}, folder.path()).code, 0);
  const ProgramResult verified = RunProgram({"verify", "run"}, folder.path());
  EXPECT_EQ(verified.code, 0) << verified.err;
  EXPECT_THAT(verified.out, HasSubstr("every file the same"));
  std::ofstream(directory / "hand" / "allegro.urdf", std::ios::app) << "<!-- changed -->\n";
  const ProgramResult changed = RunProgram({"show", "run", "--out", "again.png"}, folder.path());
  EXPECT_EQ(changed.code, 2);
  EXPECT_THAT(changed.err, HasSubstr("hand.sha256: expected that of the hand"));
}

}  // namespace
}  // namespace pregrasp
