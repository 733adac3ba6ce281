#include "app/training/evaluation_scenes.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "app/core/error.h"
#include "tests/test_folder.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

TEST(EvaluationScenesTest, AreAllThatShip) {
  std::set<std::string> names;
  for (const fs::path& file : FindEvaluationScenes(PREGRASP_SOURCE_DIR)) {
    names.insert(file.stem().string());
  }
  for (const char* name : {"ruler", "book", "plate", "spice"}) EXPECT_TRUE(names.contains(name));
}

TEST(EvaluationScenesTest, AFolderThatIsMissingOrEmptyIsAnErrorAndNeverNoExclusions) {
  const TestFolder folder;
  const fs::path data = folder.path(), scenes = data / "scenes";
  const auto missing = [&]() -> std::string {
    try {
      FindEvaluationScenes(data);
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing";
  };
  EXPECT_NE(missing().find(scenes.string()), std::string::npos) << missing();
  fs::create_directories(scenes);
  std::ofstream(scenes / "README.md") << "no scene";
  EXPECT_NE(missing().find(scenes.string()), std::string::npos) << missing();
  std::ofstream(scenes / "cup.lua") << "return {}";
  std::ofstream(scenes / "bowl.lua") << "return {}";
  EXPECT_EQ(FindEvaluationScenes(data),
            (std::vector<fs::path>{scenes / "bowl.lua", scenes / "cup.lua"}));
}

}  // namespace
}  // namespace pregrasp
