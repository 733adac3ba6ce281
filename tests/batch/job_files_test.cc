#include "app/batch/job_files.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>

#include "app/batch/item_folder.h"
#include "app/core/error.h"
#include "tests/test_folder.h"

namespace pregrasp {
namespace {

// A plan whose "program" notes its words in the file words, in a folder with a blank in its name.
class JobFilesTest : public testing::Test {
 protected:
  JobFilesTest() {
    const auto program = root_.Write(
        "program", "#!/bin/sh\necho \"$PWD: $*\" >> '" + (root_.path() / "words").string() + "'\n");
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    plan_.engine = "slurm";
    plan_.folder = root_.path() / "my jobs";
    plan_.directory = root_.path();
    plan_.command = {program.string(), "eval", "--study", "it's"};
    plan_.merge = {program.string(), "eval", "merge"};
    plan_.program = program.string();
    plan_.items_in = "made/items";
    plan_.extension = ".json";
    plan_.items = 40;
    plan_.tasks = 8;
    plan_.cpus = 2;
    plan_.minutes = 90;
    plan_.memory_mb = 1200;
  }

  std::map<std::string, std::string> Files() const {
    std::map<std::string, std::string> files;
    for (const JobFile& file : MakeJobFiles(plan_)) files[file.name] = file.text;
    return files;
  }

  // Runs a script of the plan's as Slurm does: from a copy elsewhere, with the index in the
  // environment. @returns what the program was given.
  std::string Run(const std::string& script, const std::string& index,
                  const std::string& arguments = "") {
    std::filesystem::remove(root_.path() / "words");
    const std::string line = "cd / && cp '" + (plan_.folder / script).string() + "' '" +
                             (root_.path() / "spooled").string() +
                             "' && SLURM_ARRAY_TASK_ID=" + index + " bash '" +
                             (root_.path() / "spooled").string() + "' " + arguments;
    EXPECT_EQ(std::system(line.c_str()), 0) << line;  // NOLINT: a test's own command
    return ReadWholeFile(root_.path() / "words");
  }

  std::string Task(int number) const {
    return root_.path().string() + ": eval --study it's --shard " + std::to_string(number) +
           "/8 --threads 2 --out " + (plan_.folder / "made").string() + "\n";
  }

  const TestFolder root_;
  JobPlan plan_;
};

TEST_F(JobFilesTest, ATaskIsTheShardOfItsIndexWhateverPartOfTheArrayIsSubmitted) {
  WriteJobFiles(plan_);
  EXPECT_EQ(Run("task.sbatch", "3"), Task(3));
  EXPECT_EQ(Run("task.sbatch", "3", "4"), Task(7));  // a window's offset
  EXPECT_NE(Files()["task.sbatch"].find("#SBATCH --array=1-8\n"), std::string::npos);
  plan_.first_index = 0;
  WriteJobFiles(plan_);
  EXPECT_EQ(Run("task.sbatch", "3"), Task(4));
  EXPECT_EQ(Run("task.sbatch", "0", "4"), Task(5));
  EXPECT_NE(Files()["task.sbatch"].find("#SBATCH --array=0-7\n"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(plan_.folder / "logs/task-3.txt"));
}

TEST_F(JobFilesTest, TimeAndMemoryAreAskedForWhereTheyAreKnown) {
  const std::string script = Files()["task.sbatch"];
  EXPECT_NE(script.find("#SBATCH --time=90\n#SBATCH --mem=1200M\n"), std::string::npos) << script;
  plan_.minutes = plan_.memory_mb = 0;
  EXPECT_EQ(Files()["task.sbatch"].find("--mem"), std::string::npos);
  plan_.engine = "snakemake";
  EXPECT_EQ(Files()["Snakefile"].find("resources"), std::string::npos);
  plan_.minutes = 90;
  plan_.memory_mb = 1200;
  EXPECT_NE(Files()["Snakefile"].find("resources: runtime=90, mem_mb=1200\n"), std::string::npos);
}

TEST_F(JobFilesTest, AMergeSaysHowTheItemsStandAndPutsThemTogether) {
  WriteJobFiles(plan_);
  const std::string made = (plan_.folder / "made").string();
  EXPECT_EQ(Run("merge.sbatch", ""), root_.path().string() + ": jobs status " +
                                         plan_.folder.string() + "\n" + root_.path().string() +
                                         ": eval merge " + made + " --out " +
                                         (plan_.folder / "result").string() + "\n");
}

TEST_F(JobFilesTest, ThePlanReadsBackFromItsFolder) {
  WriteJobFiles(plan_);
  const JobPlan read = ReadJobPlan(plan_.folder);
  EXPECT_EQ(read.command, plan_.command);
  EXPECT_EQ(read.merge, plan_.merge);
  EXPECT_EQ(read.folder, plan_.folder);
  const std::vector<JobFile> files = MakeJobFiles(plan_), again = MakeJobFiles(read);
  ASSERT_EQ(files.size(), again.size());
  for (std::size_t i = 0; i < files.size(); ++i) EXPECT_EQ(files[i].text, again[i].text);
  EXPECT_THROW(ReadJobPlan(root_.path()), InputError);
  root_.Write("my jobs/jobs.json", "{\"engine\": 3}");
  EXPECT_THROW(ReadJobPlan(plan_.folder), InputError);
}

}  // namespace
}  // namespace pregrasp
