// pregrasp jobs as a user types it, but for the engines: tests/cluster has them.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/bindings/run_program.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

// Runs what a task of the folder is, as an engine does.
int RunScript(const fs::path& script, const std::string& arguments = "") {
  const std::string line = "'" + script.string() + "' " + arguments + " > /dev/null 2>&1";
  const int status = std::system(line.c_str());  // NOLINT: a test's own command
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(JobsCommandTest, TasksMakeAStudyAndTheirMergeItsTables) {
  const TestFolder folder;
  const ProgramResult written = RunProgram({"jobs", "slurm", "ik-order", "--tasks", "2", "--out",
                                            "jobs", "--first-index", "0", "--", "--seeds", "3"},
                                           folder.path());
  ASSERT_EQ(written.code, 0) << written.err;
  EXPECT_NE(written.out.find("3 items in 2 tasks; submit them with jobs/submit.sh\n"),
            std::string::npos)
      << written.out;
  const fs::path jobs = folder.path() / "jobs";
  EXPECT_TRUE(fs::exists(jobs / "made/items/item-000000.json"));  // the one that was measured
  const std::string batch = ReadText(jobs / "task.sbatch");
  EXPECT_NE(batch.find("#SBATCH --array=0-1\n"), std::string::npos) << batch;
  EXPECT_NE(batch.find("#SBATCH --time=6\n#SBATCH --mem="), std::string::npos) << batch;

  EXPECT_EQ(RunScript(jobs / "task.sh", "2"), 0);
  EXPECT_EQ(RunScript(jobs / "task.sh", "3"), 2);  // there are two
  EXPECT_EQ(RunScript(jobs / "merge.sh"), 2);
  EXPECT_FALSE(fs::exists(jobs / "result"));
  ProgramResult status = RunProgram({"jobs", "status", "jobs", "--incomplete"}, folder.path());
  EXPECT_EQ(status.out, "0 0\n");
  status = RunProgram({"jobs", "status", "jobs", "--complete"}, folder.path());
  EXPECT_EQ(status.code, 2);
  EXPECT_EQ(status.err, "jobs: expected all 3 items, got 2 of them\n");

  EXPECT_EQ(RunScript(jobs / "task.sh", "1"), 0);
  EXPECT_EQ(RunScript(jobs / "merge.sh"), 0);
  EXPECT_EQ(RunProgram({"jobs", "status", "jobs", "--incomplete"}, folder.path()).out, "");
  EXPECT_EQ(nlohmann::json::parse(ReadText(jobs / "result/ik-order.json")).size(), 3U);
  const std::string table = ReadText(jobs / "runs.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 4) << table;
  EXPECT_NE(table.find("\n1,2,done,"), std::string::npos) << table;
  EXPECT_NE(table.find("logs/task-2.txt"), std::string::npos) << table;

  // Cut anew, what is made is kept; another study is refused.
  const std::vector<std::string> again = {"jobs",  "parallel", "ik-order", "--tasks", "3",
                                          "--out", "jobs",     "--",       "--seeds", "3"};
  EXPECT_EQ(RunProgram(again, folder.path()).code, 0);
  EXPECT_EQ(RunProgram({"jobs", "status", "jobs", "--complete"}, folder.path()).code, 0);
  std::vector<std::string> other = again;
  other.back() = "4";
  const ProgramResult refused = RunProgram(other, folder.path());
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find("a new folder, or one of the same command"), std::string::npos);
}

TEST(JobsCommandTest, ADryRunShowsWhatWouldRunAndWritesNothing) {
  const TestFolder folder;
  const ProgramResult result =
      RunProgram({"jobs", "snakemake", "--tasks", "2", "--cpus", "3", "--out", "jobs", "--dry-run",
                  "--", "dataset", "grasps", "--items", "5"},
                 folder.path());
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.out.find("task 1: 3 items, 0 of them made: "), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("dataset grasps --items 5 --shard 2/2 --threads 3 --out "),
            std::string::npos);
  EXPECT_NE(result.out.find("rule merge:"), std::string::npos);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(JobsCommandTest, AStudysWordsMayStandBeforeTheDashesAndAfterThem) {
  const TestFolder folder;
  const auto commands = [&](const std::vector<std::string>& study) {
    std::vector<std::string> words = {"jobs", "slurm", "--tasks", "2", "--out", "x", "--dry-run"};
    words.insert(words.end(), study.begin(), study.end());
    const ProgramResult result = RunProgram(words, folder.path());
    EXPECT_EQ(result.code, 0) << result.err;
    return result.out;
  };
  const std::string after = commands({"--", "dataset", "grasps", "--items", "4"});
  EXPECT_NE(after.find("dataset grasps --items 4 --shard 1/2"), std::string::npos) << after;
  EXPECT_EQ(commands({"dataset", "--", "grasps", "--items", "4"}), after);
  EXPECT_EQ(commands({"dataset", "grasps", "--", "--items", "4"}), after);
}

TEST(JobsCommandTest, BadInputIsOneLineAndLeavesNothing) {
  const TestFolder folder;
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"nothing", "--tasks", "2", "--out", "x"}, "STUDY: expected the name of a study"},
      {{"dataset", "graps", "--tasks", "2", "--out", "x"},
       "got \"dataset graps\" (did you mean \"dataset grasps\"?)"},
      {{"dataset", "grasps", "--tasks", "2", "--out", "x", "--items", "4"},
       "got \"--items\": options of the study follow --, as in: pregrasp jobs slurm "},
      {{"ik-order", "--out", "x"}, "--tasks"},
      {{"ik-order", "--tasks", "0", "--out", "x"}, "--tasks"},
      {{"ik-order", "--tasks", "4", "--out", "x"}, "--tasks: expected 1 to 3, the number of items"},
      {{"--tasks", "2", "--out", "x", "--", "eval", "--shard", "1/2"}, "got --shard"},
      {{"--tasks", "2", "--out", "x", "--", "eval", "--out=y"}, "got --out"},
      {{"--tasks", "2", "--out", "x", "--", "dataset", "merge", "y"}, "STUDY"},
      {{"--tasks", "2", "--out", "x", "--", "eval", "--scenes", "nowhere"}, "--scenes"},
      {{"--tasks", "2", "--out", "x", "--", "eval", "--set", "fingertips.friction=2"}, "the rules"},
  };
  for (const auto& [more, words] : cases) {
    std::vector<std::string> arguments = {"jobs", "slurm"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = RunProgram(arguments, folder.path());
    EXPECT_EQ(result.code, 2) << words << ": " << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_NE(result.err.find(words), std::string::npos) << words << ": " << result.err;
  }
  EXPECT_EQ(RunProgram({"jobs", "status", "."}, folder.path()).code, 2);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

}  // namespace
}  // namespace pregrasp
