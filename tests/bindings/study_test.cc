// Studies of many scenes and seeds from scripts: pg.eval. The networks' weights are random
// (planner_script.h).
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "app/core/interrupt.h"
#include "tests/bindings/planner_script.h"

namespace pregrasp {
namespace {

// Each item takes a second: nothing can be lifted at this friction.
const char* const kStudy = R"(
local function study(more)
  local options = { dir = "out/study", scenes = { "scenes/ruler.lua" }, seeds = 2, first_seed = 7, paths = 1,
    set = { ["fingertips.friction"] = 0.1, ["graph.samples"] = 1, ["screen.paths"] = 4, ["screen.samples"] = 8, ["mppi.samples"] = 8,
      ["mppi.iterations"] = 2, ["grasps.samples"] = 2, ["grasps.max_solves"] = 2, ["grasps.starts"] = 2, ["grasps.search_sets"] = 4096,
      ["grasps.search_found"] = 1 } }
  for key, value in pairs(more or {}) do options[key] = value end
  return pg.eval(options)
end
)";

class StudyScriptTest : public PlannerScriptTest {};

TEST_F(StudyScriptTest, GivesTheRowsOfItsTableAndMakesNoneTwice) {
  setenv("XDG_CACHE_HOME", (folder_.path() / "cache").c_str(), 1);  // for the program's verdicts
  const std::string first = Script(kStudy + std::string(R"(
    local rows = study{ keep_runs = true }
    for _, row in ipairs(rows) do print(row.scene, row.seed, row.status, row.n_paths) end
    local run = pg.load("out/study/runs/ruler-8")
    print(run.summary.seed, run.summary.status == rows[2].status)
    print(select(2, pcall(study, { seeds = 3 })):find('another batch (items: 3 and 2)', 1, true) ~= nil))"));
  std::ifstream in(folder_.path() / "out/study/table1.json");
  const nlohmann::json table = nlohmann::json::parse(in);
  ASSERT_EQ(table.size(), 2U);
  std::string expected;
  for (const nlohmann::json& row : table) {
    expected += "ruler\t" + row["seed"].dump() + "\t" + row["status"].get<std::string>() + "\t" +
                (row["n_paths"].is_null() ? "nil" : row["n_paths"].dump()) + "\n";
  }
  EXPECT_EQ(first, expected + "8\ttrue\ntrue\n");
  // What is there is read, and nothing made, be it interrupted at once.
  RequestInterrupt();
  EXPECT_THROW(Script(kStudy + std::string("study{ dir = 'out/other' }")), Interrupted);
  ClearInterrupt();
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "out/other/table1.json"));
  EXPECT_EQ(Script(kStudy + std::string("print(#study{ keep_runs = true })")), "2\n");
}

TEST_F(StudyScriptTest, TakesScenesBuiltInTheScriptAndRefusesWhatNoTableMayHold) {
  const std::string scene = R"(
local function cube(friction) return { name = "cube",
  object = { shape = pg.box{ 0.065, 0.065, 0.065 }, mass = 0.05, friction = friction, p = { 0, 0, 0.3325 } },
  environment = { { name = "post", shape = pg.box{ 0.03, 0.03, 0.3 }, p = { 0, 0, 0.15 }, friction = 0.5 } } } end
)";
  setenv("XDG_CACHE_HOME", (folder_.path() / "cache").c_str(), 1);
  EXPECT_EQ(Script(kStudy + scene + R"(
    print(study{ scenes = { pg.scene(cube(0.5)) }, seeds = 1 }[1].scene)
    print(select(2, pcall(study, { dir = "out/b", scenes = { cube(0.9) } })):match("within the rules[^:]*"))
    print(select(2, pcall(study, { dir = "out/b", scenes = { cube(0.5), cube(0.4) } })):match("scenes:.*")))"),
            "cube\nwithin the rules, as for every table, got friction 0.9 of \"object\" is outside "
            "0.2 to 0.6\n"
            "scenes: expected scenes of different names, got \"cube\" twice\n");
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "out/b"));
}

TEST_F(StudyScriptTest, WrongCallsSayWhatWasExpected) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"pg.eval{}", "eval: dir: expected a text, got nothing"},
      {"pg.eval{ dir = 'out/x' }", "eval: scenes: expected a list, got nothing"},
      {"pg.eval{ dir = '/tmp/x', scenes = { 'scenes/ruler.lua' } }",
       "eval: /tmp/x: expected a path in the output folder (\"out/..\"), got one elsewhere"},
      {"pg.eval{ dir = 'out/x', scenes = {} }",
       "eval: scenes: expected a list of one or more, got a table"},
      {"pg.eval{ dir = 'out/x', study = 'table9' }",
       "eval: study: expected table1, ladder, learning, ik-order, got \"table9\""},
      {"pg.eval{ dir = 'out/x', study = 'ik-order', scenes = {} }",
       "eval: scenes: expected none, as the study makes its own problems, got a table"},
      {"pg.eval{ dir = 'out/x', scenes = { 'scenes/ruler.lua' }, seeds = 0 }",
       "eval: seeds: expected a whole number from 1 to 10000, got 0"},
      {"pg.eval{ dir = 'out/x', scenes = { 'scenes/ruler.lua' }, first_seed = -1 }",
       "eval: first_seed: expected a whole number, 0 or more, got -1"},
      {"pg.eval{ dir = 'out/x', scenes = { 'scenes/ruler.lua' }, sedes = 1 }",
       "eval: unknown key \"sedes\" (did you mean \"seeds\"?)"},
      {"pg.eval{ dir = 'out/x', scenes = { 'scenes/rular.lua' } }",
       "eval: scenes/rular.lua: expected a file, got nothing of that name (did you mean "
       "\"scenes/ruler.lua\"?)"},
      {"pg.eval{ dir = 'out/x', scenes = { 'scenes/ruler.lua' }, set = { ['mppi.sampels'] = 3 } }",
       "mppi.samples"},
  };
  for (const auto& [call, expected] : cases) {
    const std::string failure = Failure(call);
    EXPECT_NE(failure.find(expected), std::string::npos) << call << ": " << failure;
  }
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "out/x"));
}

TEST_F(StudyScriptTest, ALinkInItsFolderCannotLeadOutOfTheOutput) {
  std::filesystem::create_directories(folder_.path() / "out/linked");
  std::filesystem::create_directories(folder_.path() / "elsewhere");
  std::filesystem::create_directory_symlink(folder_.path() / "elsewhere",
                                            folder_.path() / "out/linked/items");
  EXPECT_EQ(Failure("pg.eval{ dir = 'out/linked', scenes = { 'scenes/ruler.lua' } }"),
            "eval: out/linked/items: expected a path in the output folder (\"out/..\"), got one "
            "elsewhere");
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path() / "elsewhere"));
}

}  // namespace
}  // namespace pregrasp
