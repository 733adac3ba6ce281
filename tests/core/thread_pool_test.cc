#include "app/core/thread_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

#include "app/core/interrupt.h"

namespace pregrasp {
namespace {

TEST(ThreadPoolTest, RunsEveryIndexOnceOnEveryThreadCount) {
  for (const int threads : {1, 2, 5}) {
    ThreadPool pool(threads);
    EXPECT_EQ(pool.num_threads(), threads);
    for (const int count : {0, 1, 3, 1000}) {
      std::vector<std::atomic<int>> calls(count);
      pool.ParallelFor(count, [&](int index, int worker) {
        ASSERT_GE(worker, 0);
        ASSERT_LT(worker, threads);
        ++calls[index];
      });
      for (const auto& n : calls) EXPECT_EQ(n, 1);
    }
  }
}

TEST(ThreadPoolTest, RethrowsTheLowestFailingIndexAndStaysUsable) {
  ThreadPool pool(3);
  for (int repeat = 0; repeat < 20; ++repeat) {
    try {
      pool.ParallelFor(100, [](int index, int) {
        if (index % 7 == 5) throw std::runtime_error(std::to_string(index));
      });
      FAIL() << "no exception";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "5");
    }
  }
}

TEST(ThreadPoolTest, AnInterruptEndsALoopWithWhatHasBegun) {
  for (const int threads : {1, 3}) {
    ThreadPool pool(threads);
    std::atomic<int> done = 0;
    const auto body = [&](int, int) {
      if (++done == 10) RequestInterrupt();
    };
    EXPECT_THROW(pool.ParallelFor(1000, body), Interrupted);
    ClearInterrupt();
    EXPECT_GE(done, 10);
    EXPECT_LT(done, 10 + threads);
    done = 0;
    pool.ParallelFor(5, [&](int, int) { ++done; });
    EXPECT_EQ(done, 5);
  }
}

}  // namespace
}  // namespace pregrasp
