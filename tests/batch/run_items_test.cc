#include "app/batch/run_items.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "app/batch/item_record.h"
#include "app/core/check.h"
#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "tests/test_folder.h"

namespace pregrasp {
namespace {

BatchRun Batch(std::int64_t items, const Shard& shard = {}, int threads = 1) {
  BatchRun run;
  run.items = items;
  run.shard = shard;
  run.threads = threads;
  return run;
}

class RunItemsTest : public testing::Test {
 protected:
  RunItemsTest() : folder_(root_.path(), "{}", ".txt") { ClearInterrupt(); }
  ~RunItemsTest() override { ClearInterrupt(); }

  // The items made, sorted.
  std::vector<std::int64_t> Run(const BatchRun& run,
                                const std::function<void(const BatchProgress&)>& progress = {}) {
    std::vector<std::int64_t> made;
    std::mutex mutex;
    const auto make = [&](std::int64_t index) {
      WriteWholeFile(folder_.PathOf(index), std::to_string(index));
      const std::lock_guard lock(mutex);
      made.push_back(index);
      return "number " + std::to_string(index);
    };
    try {
      RunItems(run, folder_, make, progress);
    } catch (const Interrupted&) {
      ClearInterrupt();
    }
    std::sort(made.begin(), made.end());
    return made;
  }

  const TestFolder root_;
  const ItemFolder folder_;
};

TEST_F(RunItemsTest, AShardMakesItsItemsAndAnotherTheRest) {
  EXPECT_EQ(Run(Batch(7, {2, 3}, 1)), (std::vector<std::int64_t>{1, 4}));
  EXPECT_EQ(Run(Batch(7, {1, 1}, 3)), (std::vector<std::int64_t>{0, 2, 3, 5, 6}));
  EXPECT_TRUE(Run(Batch(7, {1, 1}, 3)).empty());
}

TEST_F(RunItemsTest, WhatWasCutOffGoesOnWhereItWas) {
  std::vector<std::int64_t> counts;
  const auto interrupt = [&](const BatchProgress& progress) {
    EXPECT_EQ(progress.total, 5);
    counts.push_back(progress.done);
    if (progress.done == 2) RequestInterrupt();
  };
  EXPECT_EQ(Run(Batch(5), interrupt), (std::vector<std::int64_t>{0, 1}));
  EXPECT_EQ(counts, (std::vector<std::int64_t>{0, 1, 2}));
  // As a kill in the middle of writing leaves it.
  std::ofstream(root_.path() / "item-000002.txt.1.partial") << "half";
  EXPECT_EQ(Run(Batch(5)), (std::vector<std::int64_t>{2, 3, 4}));
}

TEST_F(RunItemsTest, BadInputEndsTheRunAndItsItemIsNotDone) {
  const auto fail = [&](std::int64_t index) {
    if (index == 1) throw InputError("", "item", "a good one", "a bad one");
    WriteWholeFile(folder_.PathOf(index), "");
    return std::string();
  };
  EXPECT_THROW(RunItems(Batch(3), folder_, fail, {}), InputError);
  EXPECT_TRUE(folder_.Has(0));
  EXPECT_FALSE(folder_.Has(1));
  EXPECT_FALSE(folder_.Has(2));
}

TEST_F(RunItemsTest, OurBugInOneItemLeavesTheOthersAndSaysHowToMakeItAlone) {
  const auto fail = [&](std::int64_t index) {
    PREGRASP_CHECK(index != 1, index);
    WriteWholeFile(folder_.PathOf(index), "");
    return std::string();
  };
  try {
    RunItems(Batch(3), folder_, fail, {});
    FAIL();
  } catch (const InternalError& error) {
    const std::string text = error.what();
    EXPECT_EQ(text.find("1 of 3 items failed; item 1: "), 0U) << text;
    EXPECT_NE(text.find(" --shard 2/3"), std::string::npos) << text;
  }
  EXPECT_FALSE(folder_.Has(1));
  EXPECT_TRUE(folder_.Has(2));
}

TEST_F(RunItemsTest, EachItemHasARecord) {
  BatchRun run = Batch(3);
  run.records = root_.path() / "records";
  EXPECT_EQ(Run(run,
                [](const BatchProgress& progress) {
                  if (progress.done == 2) RequestInterrupt();
                }),
            (std::vector<std::int64_t>{0, 1}));
  const std::optional<ItemRecord> record = ReadRecord(run.records, 1);
  ASSERT_TRUE(record);
  EXPECT_EQ(record->verdict, "done");
  EXPECT_EQ(record->text, "number 1");
  EXPECT_GT(record->peak_rss_mb, 1.0);
  EXPECT_FALSE(ReadRecord(run.records, 2));
  const auto fail = [](std::int64_t) -> std::string { throw InputError("", "x", "y", "z"); };
  EXPECT_THROW(RunItems(run, folder_, fail, {}), InputError);
  EXPECT_EQ(ReadRecord(run.records, 2)->verdict, "failed");
  EXPECT_EQ(ReadRecord(run.records, 2)->text, "x: expected y, got z");
}

TEST_F(RunItemsTest, CountingMakesNothing) {
  BatchRun run = Batch(7, {2, 3});
  run.only_count = true;
  BatchProgress counts;
  EXPECT_TRUE(Run(run, [&](const BatchProgress& progress) { counts = progress; }).empty());
  EXPECT_EQ(DescribeCounts("x", counts), "x: 7 items, 2 in this shard, 0 of them made");
  EXPECT_EQ(ParseItemCount(DescribeCounts("9 items, x: 3 items", counts) + "\n"), 7);
  EXPECT_FALSE(ParseItemCount("7 items"));
}

TEST_F(RunItemsTest, NonsenseIsRefused) {
  const auto nothing = [](std::int64_t) { return std::string(); };
  EXPECT_THROW(RunItems(Batch(0), folder_, nothing, {}), InputError);
  EXPECT_THROW(RunItems(Batch(3, {3, 2}), folder_, nothing, {}), InputError);
}

}  // namespace
}  // namespace pregrasp
