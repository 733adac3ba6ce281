// The real program on scenes that are wrong: each ends as one line on stderr and exit code 2, and
// leaves nothing behind. A file's first line says what the line must contain.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/bindings/lua_text.h"
#include "tests/bindings/run_program.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

fs::path BadScenes() { return fs::path(PREGRASP_SOURCE_DIR) / "tests/bindings/bad_scenes"; }

std::vector<std::string> BadSceneNames() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(BadScenes())) {
    if (entry.path().extension() == ".lua") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

void ExpectOneLine(const ProgramResult& result, const std::string& expected) {
  EXPECT_EQ(result.code, 2);
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  EXPECT_EQ(result.err.find('\n'), result.err.size() - 1) << result.err;
  EXPECT_NE(result.err.find(expected), std::string::npos) << result.err << "lacks " << expected;
}

class BadSceneTest : public testing::TestWithParam<std::string> {};

TEST_P(BadSceneTest, IsOneLineAndExitCode2AndLeavesNothingBehind) {
  const TestFolder folder;
  fs::copy(BadScenes(), folder.path() / "scenes");
  const std::string file = "scenes/" + GetParam() + ".lua";
  const std::string marker = "-- expect: ";
  std::string expected;
  std::ifstream in(folder.path() / file);
  std::getline(in, expected);
  ASSERT_EQ(expected.find(marker), 0U) << "the first line says what to expect";
  expected = expected.substr(marker.size());

  const auto before = ListFiles(folder.path());
  ExpectOneLine(RunProgram({"check", file}, folder.path()), "scenes/" + expected);
  EXPECT_EQ(ListFiles(folder.path()), before);
}

INSTANTIATE_TEST_SUITE_P(Files, BadSceneTest, testing::ValuesIn(BadSceneNames()),
                         [](const auto& scene) { return scene.param; });

TEST(BadFileTest, WhatIsNoLuaFileIsOneLine) {
  const TestFolder folder;
  folder.Write("empty.lua", "");
  folder.Write("bytecode.lua", std::string("\x1bLua\x54\x00\x19\x93", 8));
  folder.Write("zeros.lua", std::string(1000, '\0'));
  folder.Write("folder.lua/file", "");
  fs::create_symlink("loop.lua", folder.path() / "loop.lua");
  const std::pair<std::string, std::string> cases[] = {
      {"empty.lua", "empty.lua: expected \"return scene { .. }\" at its end, got nothing"},
      {"bytecode.lua", "bytecode.lua: expected Lua as text, got bytecode"},
      {"zeros.lua", "zeros.lua:1: unexpected symbol"},
      {"folder.lua", "folder.lua: expected a file, got a folder"},
      {"loop.lua", "loop.lua: expected a file, got one that cannot be reached (Too many levels"},
      {"missing.lua", "missing.lua: expected a file, got nothing of that name"},
      {"/dev/zero", "/dev/zero: expected a file, got a device"},
      {"", "expected a value, got an empty one"},
  };
  for (const auto& [file, expected] : cases) {
    SCOPED_TRACE(file);
    const auto before = ListFiles(folder.path());
    ExpectOneLine(RunProgram({"check", file}, folder.path()), expected);
    // A script may be empty and return nothing; all else is no script either.
    if (file != "empty.lua") ExpectOneLine(RunProgram({"script", file}, folder.path()), expected);
    EXPECT_EQ(ListFiles(folder.path()), before);
  }
}

TEST(CommandLineTest, WhatItDoesNotKnowIsOneLine) {
  const TestFolder folder;
  const std::vector<std::vector<std::string>> cases = {{"nonsense"},
                                                       {"--nonsense"},
                                                       {"check"},
                                                       {"check", "a", "b"},
                                                       {"check", "--nonsense"},
                                                       {"script"},
                                                       {"script", "--seed", "x", "a.lua"},
                                                       {"script", "--time", "-1", "a.lua"}};
  for (const auto& arguments : cases) {
    ExpectOneLine(RunProgram(arguments, folder.path()), "");
  }
}

TEST(CommandLineTest, HelpIsPlainAndSucceeds) {
  const TestFolder folder;
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{}, {"--help"}, {"check", "--help"}, {"script", "--help"}}) {
    const ProgramResult result = RunProgram(arguments, folder.path());
    EXPECT_EQ(result.code, 0);
    EXPECT_EQ(result.err, "");
    EXPECT_NE(result.out.find("Usage: pregrasp"), std::string::npos) << result.out;
  }
}

}  // namespace
}  // namespace pregrasp
