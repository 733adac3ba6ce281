#include "app/batch/run_items.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <mutex>
#include <vector>

#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "tests/test_folder.h"

namespace pregrasp {
namespace {

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
  EXPECT_EQ(Run({7, {2, 3}, 1}), (std::vector<std::int64_t>{1, 4}));
  EXPECT_EQ(Run({7, {1, 1}, 3}), (std::vector<std::int64_t>{0, 2, 3, 5, 6}));
  EXPECT_TRUE(Run({7, {1, 1}, 3}).empty());
}

TEST_F(RunItemsTest, WhatWasCutOffGoesOnWhereItWas) {
  std::vector<std::int64_t> counts;
  const auto interrupt = [&](const BatchProgress& progress) {
    EXPECT_EQ(progress.total, 5);
    counts.push_back(progress.done);
    if (progress.done == 2) RequestInterrupt();
  };
  EXPECT_EQ(Run({5, {}, 1}, interrupt), (std::vector<std::int64_t>{0, 1}));
  EXPECT_EQ(counts, (std::vector<std::int64_t>{0, 1, 2}));
  // As a kill in the middle of writing leaves it.
  std::ofstream(root_.path() / "item-000002.txt.1.partial") << "half";
  EXPECT_EQ(Run({5, {}, 1}), (std::vector<std::int64_t>{2, 3, 4}));
}

TEST_F(RunItemsTest, AnItemThatFailsEndsTheRunAndIsNotDone) {
  const auto fail = [&](std::int64_t index) {
    if (index == 1) throw InputError("", "item", "a good one", "a bad one");
    WriteWholeFile(folder_.PathOf(index), "");
  };
  EXPECT_THROW(RunItems({3, {}, 1}, folder_, fail, {}), InputError);
  EXPECT_FALSE(folder_.Has(1));
}

TEST_F(RunItemsTest, NonsenseIsRefused) {
  EXPECT_THROW(RunItems({0, {}, 1}, folder_, [](std::int64_t) {}, {}), InputError);
  EXPECT_THROW(RunItems({3, {3, 2}, 1}, folder_, [](std::int64_t) {}, {}), InputError);
}

}  // namespace
}  // namespace pregrasp
