#include "app/core/interrupt.h"

#include <gtest/gtest.h>

#include <csignal>

namespace pregrasp {
namespace {

TEST(InterruptTest, ASignalRaisesTheFlagAndNothingElse) {
  InstallInterruptHandler();
  EXPECT_NO_THROW(ThrowIfInterrupted());
  std::raise(SIGINT);
  EXPECT_TRUE(InterruptRequested());
  EXPECT_THROW(ThrowIfInterrupted(), Interrupted);
  ClearInterrupt();
  EXPECT_NO_THROW(ThrowIfInterrupted());
}

TEST(InterruptDeathTest, ASecondSignalEndsTheProgram) {
  EXPECT_EXIT(
      {
        InstallInterruptHandler();
        std::raise(SIGTERM);
        std::raise(SIGTERM);
      },
      testing::KilledBySignal(SIGTERM), "");
}

}  // namespace
}  // namespace pregrasp
