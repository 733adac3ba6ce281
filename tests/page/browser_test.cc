// The pages of runs in headless Chromium, which a developer's machine has (packages-dev.txt).
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "app/core/json_text.h"
#include "app/recording/checked_file.h"
#include "app/recording/loaded_run.h"
#include "tests/bindings/run_program.h"
#include "tests/commands/small_run.h"
#include "tests/networks/random_network.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

const std::string kScene = PREGRASP_SOURCE_DIR "/scenes/ruler.lua";

bool HasChromium() { return std::system("command -v chromium > /dev/null 2>&1") == 0; }

// What page `file` says of itself (app/page/README.md).
nlohmann::json CheckPage(const fs::path& file, const fs::path& folder) {
  const std::string command =
      "cd '" + folder.string() + "' && HOME='" + folder.string() +
      "' timeout 200 chromium --headless --no-sandbox --enable-unsafe-swiftshader "
      "--virtual-time-budget=5000 --dump-dom 'file://" +
      file.string() + "#check' > dom.html 2> chromium.err";
  EXPECT_EQ(std::system(command.c_str()), 0) << ReadText(folder / "chromium.err");
  const std::string dom = ReadText(folder / "dom.html"), name = "data-check=\"";
  const std::size_t at = dom.find(name);
  if (at == std::string::npos) return nullptr;
  std::string text =
      dom.substr(at + name.size(), dom.find('"', at + name.size()) - at - name.size());
  for (std::size_t quote; (quote = text.find("&quot;")) != std::string::npos;) {
    text.replace(quote, 6, "\"");
  }
  return ParseJson(text, "the page's check");
}

class BrowserLongTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!HasChromium()) GTEST_SKIP() << "chromium is not installed";
    setenv("XDG_CACHE_HOME", (folder_ / "cache").c_str(), 1);
  }
  nlohmann::json Show(const std::string& run) {
    const ProgramResult shown = RunProgram({"show", run, "--out", "page.html"}, folder_);
    EXPECT_EQ(shown.code, 0) << shown.err;
    EXPECT_LT(fs::file_size(folder_ / "page.html"), 5'000'000U);
    return CheckPage(folder_ / "page.html", folder_);
  }

  const TestFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

TEST_F(BrowserLongTest, APlannedRunsPageShowsEveryStepEveryReasonAndBothViews) {
  EXPECT_EQ(RunProgram({"run", kScene, "--pictures", "none"}, folder_).code, 0);
  const nlohmann::json check = Show("out/ruler");
  ASSERT_TRUE(check.is_object());
  EXPECT_EQ(check["errors"], nlohmann::json::array());
  const LoadedRun run = LoadRun(folder_ / "out" / "ruler");
  EXPECT_EQ(check["steps"], run.steps.size());
  EXPECT_EQ(check["film"], run.summary.motion.frames.value());
  EXPECT_TRUE(check["filmSeen"]);
  EXPECT_EQ(check["reasons"], 1600);  // no two alike: each names its node
  EXPECT_GT(check["chosen"], 100);
  EXPECT_GE(check["pictures"], 15);
}

TEST_F(BrowserLongTest, ARunWithoutSuccessAndOneWithoutAPlanHavePagesThatWork) {
  const fs::path weights = folder_ / "weights";
  fs::create_directories(weights);
  WriteRandomWeights(weights);
  std::vector<std::string> arguments = {"run",     kScene, "--weights",  weights.string(),
                                        "--paths", "1",    "--pictures", "none"};
  const std::vector<std::string> small = SmallRun({"fingertips.friction=0.1"});
  arguments.insert(arguments.end(), small.begin(), small.end());
  EXPECT_EQ(RunProgram(arguments, folder_).code, 3);
  nlohmann::json check = Show("out/ruler");
  ASSERT_TRUE(check.is_object());
  EXPECT_EQ(check["errors"], nlohmann::json::array());
  EXPECT_TRUE(check["filmSeen"]);

  EXPECT_EQ(RunProgram({"script", PREGRASP_SOURCE_DIR "/lua/examples/push.lua"}, folder_).code, 0);
  check = Show("out/push");
  ASSERT_TRUE(check.is_object());
  EXPECT_EQ(check["errors"], nlohmann::json::array());
  EXPECT_EQ(check["reasons"], 0);
  EXPECT_TRUE(check["filmSeen"]);
}

}  // namespace
}  // namespace pregrasp
