// The scripts of docs/guide.md, run as printed there. PREGRASP_UPDATE_GUIDE=1 prints them anew.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>

#include "tests/bindings/run_program.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

fs::path Docs() { return fs::path(PREGRASP_SOURCE_DIR) / "docs"; }

// The text between the lines `begin` and "```", the first after `from`.
struct Block {
  std::size_t begin = 0, end = 0;
};
Block FindBlock(const std::string& text, const std::string& begin, std::size_t from) {
  const std::size_t start = text.find("\n" + begin + "\n", from);
  EXPECT_NE(start, std::string::npos) << begin;
  Block block;
  block.begin = start + begin.size() + 2;
  block.end = text.find("```\n", block.begin);
  EXPECT_NE(block.end, std::string::npos);
  return block;
}

// Numbers are those of the machine where it was printed.
std::string WithoutNumbers(const std::string& text) {
  return std::regex_replace(text, std::regex(" *-?[0-9]+(\\.[0-9]+)?(e-?[0-9]+)?"), " #");
}

class GuideTest : public ::testing::TestWithParam<const char*> {};

TEST_P(GuideTest, RunsAsPrinted) {
  const std::string name = GetParam();
  std::string guide = ReadText(Docs() / "guide.md");
  const std::size_t at = guide.find("(guide/" + name + ")");
  ASSERT_NE(at, std::string::npos) << name << " is not in docs/guide.md";
  const std::string script = ReadText(Docs() / "guide" / name);
  const TestFolder folder;
  const ProgramResult result =
      RunProgram({"script", (Docs() / "guide" / name).string()}, folder.path());
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  Block code = FindBlock(guide, "```lua", at), output = FindBlock(guide, "```text", code.begin);
  if (std::getenv("PREGRASP_UPDATE_GUIDE") != nullptr) {
    guide.replace(output.begin, output.end - output.begin, result.out);
    guide.replace(code.begin, code.end - code.begin, script);
    std::ofstream(Docs() / "guide.md") << guide;
    return;
  }
  EXPECT_EQ(guide.substr(code.begin, code.end - code.begin), script);
  EXPECT_EQ(WithoutNumbers(guide.substr(output.begin, output.end - output.begin)),
            WithoutNumbers(result.out));
}

INSTANTIATE_TEST_SUITE_P(All, GuideTest,
                         testing::Values("1_first_steps.lua", "2_custom_scene.lua",
                                         "3_why_pruned.lua", "4_rewind.lua", "5_two_forks.lua",
                                         "6_picture_strip.lua", "7_parameter_sweep.lua",
                                         "8_path_filter.lua", "9_mend_the_scene.lua"));

TEST(GuideListTest, HoldsEveryScriptOfTheFolder) {
  const std::string guide = ReadText(Docs() / "guide.md");
  int count = 0;
  for (const auto& entry : fs::directory_iterator(Docs() / "guide")) {
    if (entry.path().extension() != ".lua") continue;
    ++count;
    EXPECT_NE(guide.find("(guide/" + entry.path().filename().string() + ")"), std::string::npos);
  }
  EXPECT_EQ(count, 9);
}

}  // namespace
}  // namespace pregrasp
