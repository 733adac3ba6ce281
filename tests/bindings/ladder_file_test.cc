#include "bindings/ladder_file.h"

#include <gtest/gtest.h>

#include "app/core/error.h"
#include "tests/test_folder.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

class LadderFileTest : public testing::Test {
 protected:
  Ladder Load(const std::string& text) const {
    std::vector<Setting> settings;
    return LoadLadderFile(folder_.Write("climb.lua", text), settings);
  }
  std::string Refusal(const std::string& text) const {
    try {
      Load(text);
      return "nothing";
    } catch (const InputError& error) {
      return error.what();
    }
  }

  const TestFolder folder_;
};

TEST_F(LadderFileTest, HasItsScenePosesAndPresses) {
  const Ladder ladder = Load(R"(return ladder { scene = "scenes/ruler.lua", poses = {
    { p = { -0.16, 0, 0.0015 } },
    { p = { 0, 0.5, 1 }, rpy_deg = { 0, 0, 90 }, press = { finger = "thumb", p_OC = { 1, 2, 3 } } },
  } })");
  EXPECT_EQ(ladder.name, "climb");
  EXPECT_EQ(ladder.scene.name, "ruler");
  ASSERT_EQ(ladder.poses.size(), 2U);
  EXPECT_FALSE(ladder.poses[0].press.has_value());
  EXPECT_EQ(ladder.poses[1].X_WO.translation(), Vector3(0, 0.5, 1));
  EXPECT_LT((ladder.poses[1].X_WO.linear() * Vector3::UnitX() - Vector3::UnitY()).norm(), 1e-12);
  EXPECT_EQ(ladder.poses[1].press->finger, Finger::kThumb);
  EXPECT_EQ(ladder.poses[1].press->p_OC, Vector3(1, 2, 3));
}

TEST_F(LadderFileTest, ASceneBesideTheFileComesFirstAndTakesSettings) {
  folder_.Write("mine.lua", R"(return scene { name = "mine",
    object = { shape = box{0.1, 0.1, 0.1}, mass = 1, p = {0, 0, 0.05} },
    environment = { { name = "table", shape = box{1, 1, 0.1}, p = {0, 0, -0.05} } } })");
  const fs::path file = folder_.Write(
      "climb.lua",
      R"(return ladder { scene = "mine.lua", poses = { { p = {0, 0, 0} }, { p = {0, 0, 1} } } })");
  std::vector<Setting> settings = {{"object.mass", "2"}, {"mppi.samples", "8"}};
  EXPECT_EQ(LoadLadderFile(file, settings).scene.object().mass_properties->mass, 2.0);
  ASSERT_EQ(settings.size(), 1U);
  EXPECT_EQ(settings[0].key, "mppi.samples");
}

TEST_F(LadderFileTest, MistakesAreNamedWithTheirLine) {
  const std::string poses = "poses = { { p = {0, 0, 0} }, { p = {0, 0, 1} } }";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"return 1", "return ladder { .. }"},
      {"return ladder(1)", "climb.lua:1"},
      {"return ladder { " + poses + " }", "scene"},
      {"return ladder { scene = \"nothing.lua\", " + poses + " }", "nothing.lua"},
      {"return ladder { scene = \"scenes/ruler.lua\", poses = {} }", "poses: expected 2 to 100"},
      {"return ladder { scene = \"scenes/ruler.lua\", poses = { { p = {0, 0} }, {} } }", "p"},
      {"return ladder { scene = \"scenes/ruler.lua\", pose = {} }", "poses"},
      {"return ladder { scene = \"scenes/ruler.lua\", poses = { {}, { press = { finger = "
       "\"ring\", p_OC = {0, 0, 0} } } } }",
       "thumb or index"},
      {"return ladder { scene = \"scenes/ruler.lua\", poses = { {}, { press = { finger = "
       "\"index\" } } } }",
       "poses[2].press.p_OC"},
      {"return ladder { scene = \"scenes/ruler.lua\", poses = { {}, { rpy_deg = {0, 1e9, 0} } } }",
       "rpy_deg"},
      {"while true do end", "climb.lua:1"},
  };
  for (const auto& [text, words] : cases) {
    const std::string refusal = Refusal(text);
    EXPECT_NE(refusal.find(words), std::string::npos) << text << "\n" << refusal;
  }
}

// The planner's settings alone decide what is scored at a pose; the poses themselves must be places
// where the object can be.
TEST(ShippedLaddersTest, BeginAtTheScenesStart) {
  int count = 0;
  for (const auto& entry : fs::directory_iterator(PREGRASP_SOURCE_DIR "/tests/ladders")) {
    std::vector<Setting> settings;
    const Ladder ladder = LoadLadderFile(entry.path(), settings);
    const RigidTransform& start = ladder.scene.object().X_WB;
    const RigidTransform& first = ladder.poses.front().X_WO;
    EXPECT_LT((first.translation() - start.translation()).norm(), 1e-9) << entry.path();
    EXPECT_LT((first.linear() - start.linear()).norm(), 1e-9) << entry.path();
    ++count;
  }
  EXPECT_GE(count, 8);
}

}  // namespace
}  // namespace pregrasp
