#include "app/core/error.h"

#include <gtest/gtest.h>

#include "app/core/check.h"

namespace pregrasp {
namespace {

TEST(InputErrorTest, IsOneLineWithWhereFieldExpectedAndGot) {
  const InputError error("scenes/a.lua:3", "object.mass", "a mass above 0 kg", "-1\n");
  EXPECT_STREQ(error.what(), "scenes/a.lua:3: object.mass: expected a mass above 0 kg, got -1 ");
}

TEST(InputErrorTest, LeavesOutWhatIsEmpty) {
  EXPECT_STREQ(InputError("", "--seed", "a whole number", "").what(),
               "--seed: expected a whole number");
}

TEST(CheckTest, ThrowsInternalErrorWithTheValues) {
  const int count = 3;
  try {
    PREGRASP_CHECK(count == 4, count, "apples");
    FAIL() << "no exception";
  } catch (const InternalError& error) {
    EXPECT_NE(std::string(error.what()).find("count == 4 with 3, apples"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace pregrasp
