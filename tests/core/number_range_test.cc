#include "app/core/number_range.h"

#include <gtest/gtest.h>

#include <limits>

#include "app/core/error.h"

namespace pregrasp {
namespace {

using Limits = std::numeric_limits<double>;

TEST(NumberRangeTest, HoldsItsEndsAndNothingBeyondThem) {
  const NumberRange range{-0.5, 2.0};
  for (const double value : {-0.5, 0.0, 1.999, 2.0}) EXPECT_TRUE(range.Contains(value)) << value;
  for (const double value :
       {-0.5001, 2.0001, Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity()}) {
    EXPECT_FALSE(range.Contains(value)) << value;
  }
}

TEST(NumberRangeTest, AStepLeavesItsMultiplesOnly) {
  const NumberRange even{12, 200, 2};
  EXPECT_TRUE(even.Contains(12));
  EXPECT_TRUE(even.Contains(36));
  EXPECT_FALSE(even.Contains(37));
  EXPECT_FALSE(even.Contains(36.5));
  EXPECT_FALSE((NumberRange{0, 9, 1}).Contains(3.5));
  EXPECT_FALSE((NumberRange{0, 9, 1}).Contains(Limits::quiet_NaN()));
}

TEST(NumberRangeTest, ARefusalNamesFieldRangeAndUnit) {
  const auto failure = [](const NumberRange& range, double value) {
    try {
      RequireWithin("--set", "lift.height", range, value);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(failure({0.01, 1.0, 0, "m"}, Limits::quiet_NaN()),
            "--set: lift.height: expected a number from 0.01 to 1 m, got nan");
  EXPECT_EQ(failure({4, 4096, 1}, 2),
            "--set: lift.height: expected a whole number from 4 to 4096, got 2");
  EXPECT_EQ(failure({12, 200, 2}, 13),
            "--set: lift.height: expected an even number from 12 to 200, got 13");
  EXPECT_EQ(failure({12, 200, 2}, 14), "");
}

}  // namespace
}  // namespace pregrasp
