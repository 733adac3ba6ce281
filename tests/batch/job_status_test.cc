#include "app/batch/job_status.h"

#include <gtest/gtest.h>

#include "app/batch/item_folder.h"
#include "app/core/error.h"
#include "tests/test_folder.h"

namespace pregrasp {
namespace {

std::vector<std::string> Arrays(const std::vector<std::int64_t>& tasks, int first_index,
                                std::int64_t max_array) {
  std::vector<std::string> texts;
  for (const JobArray& array : FindJobArrays(tasks, first_index, max_array)) {
    texts.push_back(std::to_string(array.offset) + " " + array.indices);
  }
  return texts;
}

using Texts = std::vector<std::string>;

TEST(JobStatusTest, TasksAreArraysInWindowsBelowMaxArraySize) {
  EXPECT_EQ(Arrays({}, 1, 1001), Texts());
  EXPECT_EQ(Arrays({3}, 1, 1001), Texts({"0 3"}));
  EXPECT_EQ(Arrays({1, 2, 3, 5, 7, 8}, 1, 1001), Texts({"0 1-3,5,7-8"}));
  EXPECT_EQ(Arrays({1, 2, 3, 5, 7, 8}, 0, 1001), Texts({"0 0-2,4,6-7"}));
  // Slurm's indices stay below MaxArraySize.
  EXPECT_EQ(Arrays({999, 1000, 1001, 1002}, 1, 1001), Texts({"0 999-1000", "1000 1-2"}));
  EXPECT_EQ(Arrays({1000, 1001, 1002}, 0, 1001), Texts({"0 999-1000", "1001 0"}));
  EXPECT_EQ(Arrays({1, 2, 3, 4, 5, 6, 7, 8}, 1, 5), Texts({"0 1-4", "4 1-4"}));
  EXPECT_THROW(Arrays({1}, 1, 1), InputError);
}

TEST(JobStatusTest, AnItemIsDoneWhenItsFileIsThereElseWhatItsRecordSays) {
  const TestFolder folder;
  JobPlan plan;
  plan.folder = folder.path();
  plan.items_in = "made/items";
  plan.extension = ".json";
  plan.items = 5;
  plan.tasks = 2;
  folder.Write("made/items/item-000000.json", "{}");
  folder.Write("made/items/item-000003.json", "{}");
  MakeFolders(folder.path() / "made/records");
  const auto write = [&](std::int64_t item, const char* verdict) {
    ItemRecord record;
    record.item = item;
    record.verdict = verdict;
    record.text = "a \"word\", and more";
    record.seconds = 2.5;
    WriteRecord(folder.path() / "made/records", record);
  };
  write(0, "done");
  write(1, "begun");
  write(2, "failed");
  write(4, "done");  // its file was taken away
  const std::vector<JobItem> items = FindJobItems(plan);
  ASSERT_EQ(items.size(), 5U);
  const Texts verdicts = {"done", "begun", "failed", "done", "waiting"};
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(items[i].verdict, verdicts[i]) << i;
    EXPECT_EQ(items[i].task, i % 2 + 1);
  }
  const std::string table = TabulateJobItems(items);
  EXPECT_EQ(table.find("item,task,verdict,seconds,"), 0U);
  EXPECT_NE(table.find("\n2,1,failed,2.50,0,\"\",\"\",\"a \"\"word\"\", and more\","),
            std::string::npos)
      << table;
  EXPECT_NE(table.find("\n1,2,begun,,,"), std::string::npos) << table;
}

}  // namespace
}  // namespace pregrasp
