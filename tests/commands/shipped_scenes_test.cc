// Every scene that ships, as `pregrasp check` sees it.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/bindings/run_program.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> ShippedScenes() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(PREGRASP_SOURCE_DIR "/scenes")) {
    if (entry.path().extension() == ".lua") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string FileOf(const std::string& name) {
  return PREGRASP_SOURCE_DIR "/scenes/" + name + ".lua";
}

// What a scene is warned of and keeps: a reconstructed core takes more convex pieces than there may
// be.
std::string KnownWarning(const std::string& name) {
  return name == "paper_roll_cloud" ? "mm thicker in contact than its mesh" : "";
}

void ExpectClean(const std::string& name, std::vector<std::string> arguments) {
  arguments.push_back(FileOf(name));
  const TestFolder folder;
  setenv("XDG_CACHE_HOME", folder.path().c_str(), 1);  // no verdict of an earlier build
  const ProgramResult result = RunProgram(arguments, folder.path());
  EXPECT_EQ(result.code, 0) << result.err;
  const std::string known = KnownWarning(name);
  if (known.empty()) {
    EXPECT_EQ(result.out.find("warning"), std::string::npos) << result.out;
    EXPECT_NE(result.out.find(": clean, "), std::string::npos) << result.out;
    return;
  }
  EXPECT_NE(result.out.find(known), std::string::npos) << result.out;
  EXPECT_NE(result.out.find(": usable, warnings: 1, "), std::string::npos) << result.out;
}

class ShippedScenesTest : public testing::TestWithParam<std::string> {};

TEST_P(ShippedScenesTest, AreAtRestWithoutOverlapAndWithinTheRules) {
  ExpectClean(GetParam(), {"check", "--no-grasps"});
}

// A search takes up to half a minute.
TEST_P(ShippedScenesTest, LongAreUngraspableAtTheStart) { ExpectClean(GetParam(), {"check"}); }

INSTANTIATE_TEST_SUITE_P(Scenes, ShippedScenesTest, testing::ValuesIn(ShippedScenes()),
                         [](const auto& scene) { return scene.param; });

// The document names every scene, and no other.
TEST(ShippedScenesTableTest, NamesEverySceneOnce) {
  const std::string text = ReadText(PREGRASP_SOURCE_DIR "/scenes/README.md");
  for (const std::string& name : ShippedScenes()) {
    const std::string row = "\n| `" + name + ".lua` |";
    EXPECT_NE(text.find(row), std::string::npos) << name;
    EXPECT_EQ(text.find(row), text.rfind(row)) << name;
  }
}

}  // namespace
}  // namespace pregrasp
