#include "app/batch/item_record.h"

#include <gtest/gtest.h>

#include "app/batch/item_folder.h"
#include "app/core/error.h"
#include "tests/test_folder.h"

namespace pregrasp {
namespace {

TEST(ItemRecordTest, ReadsBackAsItWasWritten) {
  const TestFolder folder;
  ItemRecord record;
  record.item = 12;
  record.verdict = "failed";
  record.text = "a \"quoted\"\nline, and bytes \xff";
  record.seconds = 1.25;
  record.peak_rss_mb = 300.5;
  record.host = "node7";
  record.command = "pregrasp eval --shard 13/40";
  WriteRecord(folder.path(), record);
  const auto read = ReadRecord(folder.path(), 12);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->item, 12);
  EXPECT_EQ(read->verdict, "failed");
  EXPECT_EQ(read->text.find("a \"quoted\"\nline"), 0U);
  EXPECT_EQ(read->seconds, 1.25);
  EXPECT_EQ(read->peak_rss_mb, 300.5);
  EXPECT_EQ(read->host, "node7");
  EXPECT_EQ(read->command, record.command);
  EXPECT_FALSE(ReadRecord(folder.path(), 13));
  WriteWholeFile(folder.path() / "item-000013.json", "{}");
  EXPECT_THROW(ReadRecord(folder.path(), 13), InputError);
}

TEST(ItemRecordTest, KnowsTheRunningProgramsCommandAndPlace) {
  const ItemRecord record = BeginRecord(2, 5);
  EXPECT_EQ(record.verdict, "begun");
  EXPECT_EQ(record.host, HostName());
  EXPECT_NE(record.command.find("batch_test"), std::string::npos);
  EXPECT_EQ(record.command.substr(record.command.size() - 12), " --shard 3/5");
  EXPECT_EQ(record.directory, std::filesystem::current_path());
}

}  // namespace
}  // namespace pregrasp
