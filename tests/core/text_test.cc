#include "app/core/text.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>

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

TEST(FormatDoubleTest, NanHasNoSign) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(FormatDouble(nan), "nan");
  EXPECT_EQ(FormatDouble(-nan), "nan");
}

TEST(OneLineTest, HasNoControlCharactersAndCutsBetweenCharacters) {
  EXPECT_EQ(OneLine("a\nb\t\x1b[31mc"), "a b  [31mc");
  EXPECT_EQ(OneLine(std::string(700, 'x')), std::string(600, 'x') + "..");
  EXPECT_EQ(OneLine(std::string(599, 'x') + "\u00e4\u00e4"), std::string(599, 'x') + "..");
}

TEST(FindNearestTest, FindsTypingErrorsAndNothingFarFetched) {
  const std::vector<std::string> keys = {"friction", "mass", "name", "shape"};
  EXPECT_EQ(FindNearest("fricton", keys), "friction");
  EXPECT_EQ(FindNearest("msas", keys), "mass");
  EXPECT_EQ(FindNearest("shapes", keys), "shape");
  EXPECT_EQ(FindNearest("weight", keys), "");
  EXPECT_EQ(FindNearest("bx", {"box", "boxes"}), "box");
  EXPECT_EQ(FindNearest("", keys), "");
  EXPECT_EQ(FormatHint(FindNearest("fricton", keys)), " (did you mean \"friction\"?)");
  EXPECT_EQ(FormatHint(FindNearest("weight", keys)), "");
}

}  // namespace
}  // namespace pregrasp
