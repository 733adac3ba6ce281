#include "app/studies/scatter_plot.h"

#include <gtest/gtest.h>

#include <regex>

namespace pregrasp {
namespace {

TEST(ScatterPlotTest, PointsLieByTheirValuesOnEvenTicks) {
  ScatterPlot plot;
  plot.title = "a < b";
  plot.points = {{0.0, 0.0}, {50.0, 100.0}, {100.0, 100.0}};
  const std::string svg = ToSvg(plot);
  EXPECT_NE(svg.find("a &lt; b"), std::string::npos);
  std::vector<double> x, y;
  const std::regex circle(R"re(<circle cx="([0-9.]+)" cy="([0-9.]+)")re");
  for (std::sregex_iterator it(svg.begin(), svg.end(), circle), end; it != end; ++it) {
    x.push_back(std::stod((*it)[1]));
    y.push_back(std::stod((*it)[2]));
  }
  ASSERT_EQ(x.size(), 3U);
  EXPECT_NEAR(x[1], 0.5 * (x[0] + x[2]), 0.06);
  EXPECT_EQ(y[1], y[2]);
  EXPECT_LT(y[1], y[0]);  // upwards
  EXPECT_NE(svg.find(">20<"), std::string::npos);
  EXPECT_NE(svg.find(">100<"), std::string::npos);
  EXPECT_EQ(svg.find(">120<"), std::string::npos);
}

TEST(ScatterPlotTest, NoPointsAreAnEmptyPlot) {
  EXPECT_EQ(ToSvg({}).find("<circle"), std::string::npos);
  EXPECT_EQ(ToSvg({}).find("nan"), std::string::npos);
}

}  // namespace
}  // namespace pregrasp
