// pregrasp eval as a user types it, with networks whose weights are random: what it finds is poor,
// what it tells is not.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/bindings/run_program.h"
#include "tests/commands/small_run.h"
#include "tests/networks/random_network.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

class EvalCommandTest : public testing::Test {
 protected:
  EvalCommandTest() {
    fs::create_directories(folder_ / "weights");
    setenv("XDG_CACHE_HOME", (folder_ / "cache").c_str(), 1);  // for the program's verdicts
    WriteRandomWeights(folder_ / "weights");
  }

  std::vector<std::string> Arguments(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"eval", "--weights", (folder_ / "weights").string(),
                                          "--paths", "1"};
    for (const auto& part : {SmallRun(), more}) {
      arguments.insert(arguments.end(), part.begin(), part.end());
    }
    return arguments;
  }

  ProgramResult Eval(const std::vector<std::string>& more) const {
    return RunProgram(Arguments(more), folder_);
  }

  // A table without its seconds.
  nlohmann::json ReadTable(const std::string& file) const {
    nlohmann::json rows = nlohmann::json::parse(ReadText(folder_ / file));
    for (nlohmann::json& row : rows) row.erase("seconds");
    return rows;
  }

  const TestFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

TEST_F(EvalCommandTest, ShardsPutTogetherAreOneRun) {
  const std::vector<std::string> scenes = {"--scenes", "ruler,cardboard", "--seeds",
                                           "1",        "--first-seed",    "7"};
  const auto with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all = scenes;
    all.insert(all.end(), more.begin(), more.end());
    return Eval(all);
  };
  const ProgramResult whole = with({"--out", "whole", "--threads", "1"});
  ASSERT_EQ(whole.code, 0) << whole.err;
  EXPECT_NE(whole.out.find("ruler seed 7: "), std::string::npos) << whole.out;
  EXPECT_NE(whole.out.find("whole: complete"), std::string::npos) << whole.out;
  EXPECT_EQ(with({"--out", "a", "--shard", "1/2", "--threads", "2"}).code, 0);
  EXPECT_FALSE(fs::exists(folder_ / "a" / "table1.json"));
  EXPECT_EQ(with({"--out", "b", "--shard", "2/2"}).code, 0);

  ProgramResult merged = RunProgram({"eval", "merge", "b", "--out", "half"}, folder_);
  EXPECT_EQ(merged.code, 2);
  EXPECT_NE(merged.err.find("item 0"), std::string::npos) << merged.err;
  merged = RunProgram({"eval", "merge", "b", "a", "--out", "merged"}, folder_);
  ASSERT_EQ(merged.code, 0) << merged.err;
  const nlohmann::json rows = ReadTable("whole/table1.json");
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0]["scene"], "ruler");
  EXPECT_EQ(rows[1]["scene"], "cardboard");
  for (const nlohmann::json& row : rows) {
    EXPECT_EQ(row["seed"], 7);
    EXPECT_TRUE(row["status"].is_string());
    EXPECT_TRUE(row["rollouts"].is_number_integer());
    EXPECT_EQ(row["start_certified"], true);
  }
  EXPECT_EQ(rows, ReadTable("merged/table1.json"));
  EXPECT_NE(ReadText(folder_ / "merged/table1.md").find("| ruler |"), std::string::npos);
  EXPECT_EQ(ReadText(folder_ / "merged/table1.csv").find("scene,seed,status,"), 0U);

  // Items that are there are not made again.
  const ProgramResult again = with({"--out", "merged"});
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(again.out, "merged: complete\n");

  // As another build would have made it.
  const fs::path description = folder_ / "b/items/description.json";
  std::string text = ReadText(description);
  const std::size_t digit = text.find("\"program\":\"") + 11;
  text[digit] = text[digit] == '0' ? '1' : '0';
  std::ofstream(description, std::ios::binary) << text;
  merged = RunProgram({"eval", "merge", "a", "b", "--out", "other"}, folder_);
  EXPECT_EQ(merged.code, 2);
  EXPECT_NE(merged.err.find("program: "), std::string::npos) << merged.err;
  EXPECT_FALSE(fs::exists(folder_ / "other"));
}

TEST_F(EvalCommandTest, CtrlCKeepsWhatIsDoneAndTheSameCommandGoesOn) {
  const std::vector<std::string> arguments = Arguments(
      {"--scenes", "ruler", "--seeds", "2", "--out", "cut", "--set", "fingertips.friction=0.1"});
  const TestFolder captured;
  const pid_t child = StartProgram(arguments, folder_, captured.path());
  const fs::path first = folder_ / "cut/items/item-000000.json";
  for (int i = 0; i < 4000 && !fs::exists(first); ++i) {  // 200 s, for a machine that is busy
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  ASSERT_TRUE(fs::exists(first));
  kill(child, SIGINT);
  const ProgramResult cut = AwaitProgram(child, captured.path());
  EXPECT_EQ(cut.code, 130) << cut.err;
  EXPECT_FALSE(fs::exists(folder_ / "cut/table1.json"));
  for (const auto& entry : fs::directory_iterator(folder_ / "cut/items")) {
    EXPECT_EQ(entry.path().extension(), ".json");
    EXPECT_TRUE(nlohmann::json::accept(ReadText(entry.path()))) << entry.path();
  }
  const std::string kept = ReadText(first);
  const ProgramResult rest = RunProgram(arguments, folder_);
  EXPECT_EQ(rest.code, 0) << rest.err;
  EXPECT_EQ(rest.out.find("ruler seed 1: "), std::string::npos) << rest.out;
  EXPECT_EQ(ReadText(first), kept);
  EXPECT_EQ(ReadTable("cut/table1.json").size(), 2U);
}

TEST_F(EvalCommandTest, AFolderOfOtherSettingsIsRefusedWithTheDifference) {
  const auto with = [&](const std::string& seeds, const std::string& patience) {
    return Eval({"--scenes", "ruler", "--seeds", seeds, "--out", "x", "--set",
                 "fingertips.friction=0.1", "--set", "mppi.patience=" + patience});
  };
  EXPECT_EQ(with("1", "4").code, 0);
  const ProgramResult other = with("1", "3");
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.err.find("mppi.patience: 3 and 4"), std::string::npos) << other.err;
  EXPECT_EQ(with("2", "4").code, 2);
}

TEST_F(EvalCommandTest, AReportHasTheTablesAndAPictureOfARunThatWasKept) {
  ASSERT_EQ(Eval({"--scenes", "ruler", "--seeds", "1", "--out", "x", "--keep-runs"}).code, 0);
  const ProgramResult result = RunProgram({"eval", "report", "x", "--out", "results.md"}, folder_);
  ASSERT_EQ(result.code, 0) << result.err;
  const std::string text = ReadText(folder_ / "results.md");
  EXPECT_NE(text.find(ReadText(folder_ / "x/table1.md")), std::string::npos) << text;
  EXPECT_NE(text.find("Seeds 1 to 1, at most 1 paths; "), std::string::npos) << text;
  EXPECT_NE(text.find("mppi.iterations = 2"), std::string::npos) << text;
  EXPECT_NE(text.find("(results/table1-ruler-1.png)"), std::string::npos) << text;
  EXPECT_EQ(ReadText(folder_ / "results/table1-ruler-1.png").substr(1, 3), "PNG");
  EXPECT_EQ(RunProgram({"eval", "report", "nothing", "--out", "other.md"}, folder_).code, 2);
  EXPECT_FALSE(fs::exists(folder_ / "other.md"));
}

TEST_F(EvalCommandTest, ALadderHasARowForEachPoseAndAnOraclesRun) {
  const ProgramResult result =
      Eval({"--study", "ladder", "--scenes", "ruler", "--seeds", "1", "--out", "ladder"});
  ASSERT_EQ(result.code, 0) << result.err;
  const nlohmann::json table = nlohmann::json::parse(ReadText(folder_ / "ladder/ladder.json"));
  ASSERT_EQ(table.size(), 1U);
  const nlohmann::json& poses = table[0]["poses"];
  ASSERT_EQ(poses.size(), 8U);
  for (const nlohmann::json& pose : poses) {
    EXPECT_EQ(pose["overlap_mm"], 0.0);
    EXPECT_EQ(pose["holds"], true);
    EXPECT_EQ(pose["stays_when_released"], true);
  }
  EXPECT_EQ(poses[0]["found"], 0);  // flat on the table
  EXPECT_GT(poses[7]["found"], 0);  // 6 cm over the edge
  EXPECT_NEAR(poses[7]["moved_mm"], 70.0, 1e-9);
  ASSERT_EQ(table[0]["oracle"].size(), 1U);
  EXPECT_GE(table[0]["oracle"][0]["progress"], 0.0);
  EXPECT_LE(table[0]["oracle"][0]["progress"], 1.0);
  EXPECT_NE(ReadText(folder_ / "ladder/ladder.md").find("| ruler | 1 | 8 | 70 mm, 0 deg |"),
            std::string::npos);
}

TEST_F(EvalCommandTest, BadInputIsOneLineAndLeavesNothing) {
  const auto before = ListFiles(folder_);
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{}, "--out: expected a folder"},
      {{"--out", "x", "--study", "table9"}, "--study: expected table1, ladder"},
      {{"--out", "x", "--scenes", "nothing"}, "--scenes"},
      {{"--out", "x", "--scenes", ""}, "--scenes"},
      {{"--out", "x", "--scenes", ","}, "--scenes"},
      {{"--out", "x", "--scenes", "ruler,ruler"}, "\"ruler\" twice"},
      {{"--out", "x", "--scenes", "../scenes/ruler"}, "--scenes"},
      {{"--out", "x", "--seeds", "0"}, "--seeds: expected a whole number from 1 to 10000"},
      {{"--out", "x", "--seeds", "2.5"}, "--seeds"},
      {{"--out", "x", "--seeds", "-1"}, "--seeds"},
      {{"--out", "x", "--first-seed", "-1"}, "--first-seed"},
      {{"--out", "x", "--first-seed", "18446744073709551615"}, "--first-seed"},
      {{"--out", "x", "--shard", "3/2"}, "--shard"},
      {{"--out", "x", "--shard", "1"}, "--shard"},
      {{"--out", "x", "--scenes", "ruler", "--set", "mppi.sampels=3"}, "mppi.samples"},
      {{"--out", "x", "--scenes", "ruler", "--set", "certify.hold_seconds=0.5"},
       "within the rules"},
      {{"--out", "x", "--scenes", "ruler", "--set", "fingertips.friction=1.2"}, "within the rules"},
      {{"--out", "x", "--study", "ladder", "--scenes", "ruler", "--set", "fingertips.friction=1.2"},
       "within the rules"},
      {{"--out", "x", "--study", "ik-order", "--set", "motion.wrist_speed=5"}, "within the rules"},
      {{"--out", "x", "--study", "ik-order", "--scenes", "ruler"}, "--scenes: expected none"},
      {{"--out", "x", "--weights", "nowhere"}, "nowhere"},
      {{"--out", "/proc/nowhere", "--scenes", "ruler"}, "/proc/nowhere"},
      {{"merge", "--out", "x"}, "DIRS"},
      {{"merge", "nothing", "--out", "x"}, "nothing"},
  };
  for (const auto& [more, words] : cases) {
    std::vector<std::string> arguments = {"eval"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = RunProgram(arguments, folder_);
    EXPECT_EQ(result.code, 2) << words << ": " << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_NE(result.err.find(words), std::string::npos) << words << ": " << result.err;
  }
  EXPECT_EQ(ListFiles(folder_), before);
}

}  // namespace
}  // namespace pregrasp
