#include "app/core/json_text.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <sstream>

#include "app/core/error.h"
#include "app/core/rng.h"

namespace pregrasp {
namespace {

std::uint64_t ReadBack(double value) {
  const nlohmann::json json = ParseJson(FormatJson(value), "test");
  EXPECT_TRUE(json.is_number_float()) << FormatJson(value);
  return std::bit_cast<std::uint64_t>(json.get<double>());
}

TEST(JsonTextTest, NumbersReadBackAsTheSameBitsAndStayFloatingPoint) {
  Rng rng(3);
  for (int i = 0; i < 1000; ++i) {
    const double value = rng.Normal() * std::pow(10.0, rng.Uniform(-300, 300));
    EXPECT_EQ(ReadBack(value), std::bit_cast<std::uint64_t>(value));
  }
  using Limits = std::numeric_limits<double>;
  for (const double value : {0.0, -0.0, 1.0, -3.0, 0.1, 1e22, 1e-9, Limits::max(), Limits::min(),
                             Limits::denorm_min(), -Limits::epsilon()}) {
    EXPECT_EQ(ReadBack(value), std::bit_cast<std::uint64_t>(value)) << value;
  }
}

TEST(JsonTextTest, TheTextIsTheShortest) {
  EXPECT_EQ(FormatJson({{"b", 0.1}, {"a", {1, 2.0, -0.0}}}), R"({"b":0.1,"a":[1,2.0,-0.0]})");
}

TEST(JsonTextTest, WhatIsNotANumberIsNull) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(FormatJson({std::nan(""), infinity, -infinity}), "[null,null,null]");
}

TEST(JsonTextTest, BytesThatAreNotUtf8AreReplaced) {
  EXPECT_EQ(ParseJson(FormatJson("a\xff"), "test"), "a\xef\xbf\xbd");
}

TEST(JsonTextTest, IndentedTextHoldsTheSameValueInLinesOfAtMostAHundredColumns) {
  Rng rng(4);
  for (int round = 0; round < 50; ++round) {
    nlohmann::ordered_json value = nlohmann::ordered_json::object();
    for (int i = 0; i < 8; ++i) {
      nlohmann::ordered_json list = nlohmann::ordered_json::array();
      while (rng.Uniform() < 0.8) list.push_back({{"x", rng.Normal()}, {"name", "value"}});
      value["key" + std::to_string(i)] = {{"list", list}, {"deeper", {{"z", i}, {"a", nullptr}}}};
    }
    const std::string text = FormatJsonIndented(value);
    EXPECT_EQ(nlohmann::ordered_json::parse(text), value);
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100U) << line;
    EXPECT_EQ(text.back(), '\n');
  }
}

TEST(JsonTextTest, WhatIsNotJsonIsReportedInOneLineWithItsPlace) {
  try {
    ParseJson("{\"a\": [1,\n 2", "file.json");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find("file.json: expected JSON, got "), 0U) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
}

}  // namespace
}  // namespace pregrasp
