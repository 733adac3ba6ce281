#include "app/core/json_difference.h"

#include <gtest/gtest.h>

#include <vector>

namespace pregrasp {
namespace {

using Json = nlohmann::ordered_json;

std::vector<JsonDifference> FindAll(const std::string& left, const std::string& right) {
  std::vector<JsonDifference> all;
  EXPECT_TRUE(VisitDifferences(Json::parse(left), Json::parse(right), [&](const auto& found) {
    all.push_back(found);
    return true;
  }));
  return all;
}

TEST(JsonDifferenceTest, TheSameDocumentsHaveNone) {
  EXPECT_TRUE(FindAll(R"({"a": [1, {"b": null}]})", R"({"a": [1, {"b": null}]})").empty());
}

TEST(JsonDifferenceTest, EveryPlaceIsNamedWithBothValuesInTheOrderOfTheLeft) {
  const auto all = FindAll(R"({"z": "one", "a": [1, {"b": 0.5}], "only": {}})",
                           R"({"a": [1, {"b": 0.25}, 3], "z": "other", "more": true})");
  ASSERT_EQ(all.size(), 5U);
  EXPECT_EQ(all[0].field, "z");
  EXPECT_EQ(all[0].left, "\"one\"");
  EXPECT_EQ(all[0].right, "\"other\"");
  EXPECT_EQ(all[1].field, "a[1].b");
  EXPECT_EQ(all[1].left, "0.5");
  EXPECT_EQ(all[2].field, "a");
  EXPECT_EQ(all[2].left, "2 items");
  EXPECT_EQ(all[2].right, "3 items");
  EXPECT_EQ(all[3].field, "only");
  EXPECT_EQ(all[3].right, "nothing");
  EXPECT_EQ(all[4].field, "more");
  EXPECT_EQ(all[4].left, "nothing");
}

TEST(JsonDifferenceTest, OnlyNumbersThatAreNotBothWholeHaveADistance) {
  const auto all =
      FindAll(R"([1, 2.0, true, null, 1e9, 1e-9])", R"([2, 3.0, 1.5, 1.5, 2e9, 3e-9])");
  ASSERT_EQ(all.size(), 6U);
  EXPECT_FALSE(all[0].distance);
  EXPECT_DOUBLE_EQ(all[1].distance.value(), 1.0 / 3.0);
  EXPECT_FALSE(all[2].distance);
  EXPECT_FALSE(all[3].distance);
  EXPECT_DOUBLE_EQ(all[4].distance.value(), 0.5);   // relative
  EXPECT_DOUBLE_EQ(all[5].distance.value(), 2e-9);  // as it is
}

TEST(JsonDifferenceTest, VisitingEndsWhereItIsAskedTo) {
  int count = 0;
  EXPECT_FALSE(VisitDifferences(Json::parse("[1, 2, 3]"), Json::parse("[4, 5, 6]"),
                                [&](const JsonDifference&) { return ++count < 2; }));
  EXPECT_EQ(count, 2);
}

}  // namespace
}  // namespace pregrasp
