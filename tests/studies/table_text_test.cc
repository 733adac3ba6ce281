#include "app/studies/table_text.h"

#include <gtest/gtest.h>

namespace pregrasp {
namespace {

TEST(TableTextTest, MeansHaveTheirDeviationWhereThereIsOne) {
  EXPECT_EQ(MeanText({0.5, 1.0}), "0.750 (0.354)");
  EXPECT_EQ(MeanText({2.0}), "2.000");
  EXPECT_EQ(MeanText({}), "-");
}

TEST(TableTextTest, MarkdownHasAHeadAndARuler) {
  EXPECT_EQ(MarkdownTable({{"a", "b"}, {"1", "2"}}), "| a | b |\n|---|---|\n| 1 | 2 |\n");
}

TEST(TableTextTest, CellsWithCommasAndQuotesAreQuoted) {
  const std::vector<nlohmann::ordered_json> records = {
      {{"name", "a, \"b\""}, {"list", {"x", "y"}}, {"none", nullptr}, {"number", 1.5}},
      {{"name", "c"}, {"list", nlohmann::ordered_json::array()}, {"none", true}, {"number", 2}}};
  EXPECT_EQ(CsvTable(records), "name,list,none,number\n\"a, \"\"b\"\"\",x y,,1.5\nc,,true,2\n");
}

}  // namespace
}  // namespace pregrasp
