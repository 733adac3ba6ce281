#include "app/core/text.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "app/core/rng.h"

namespace pregrasp {
namespace {

TEST(FormatDoubleTest, ReadsBackAsTheSameBits) {
  Rng rng(5);
  for (int i = 0; i < 1000; ++i) {
    const double value = rng.Normal() * std::pow(10.0, rng.Uniform(-12, 12));
    EXPECT_EQ(std::strtod(FormatDouble(value).c_str(), nullptr), value);
  }
}

TEST(FormatDoubleTest, IsTheShortestText) { EXPECT_EQ(FormatDouble(0.1), "0.1"); }

}  // namespace
}  // namespace pregrasp
