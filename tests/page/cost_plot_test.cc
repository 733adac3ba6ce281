#include "app/page/cost_plot.h"

#include <gtest/gtest.h>

namespace pregrasp {
namespace {

TEST(CostPlotTest, EveryPointIsToldWithItsNumber) {
  const CostPlot plot{"Costs", "iteration", "cost", {{"best", "best", {{1, -1.5}, {2, -1.75}}}}};
  const std::string svg = ToSvg(plot);
  EXPECT_NE(svg.find("<title>iteration 1: best -1.5</title>"), std::string::npos) << svg;
  EXPECT_NE(svg.find("<title>iteration 2: best -1.75</title>"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("cut off"), std::string::npos);
}

TEST(CostPlotTest, OneLargeValueDoesNotPressTheRestFlatAndThePlotSaysSo) {
  CostPlot plot{"Costs", "iteration", "cost", {{"mean", "mean", {{1, 1e6}}}}};
  for (int i = 2; i < 30; ++i) plot.lines[0].points.emplace_back(i, 1.0 / i);
  const std::string svg = ToSvg(plot);
  EXPECT_NE(svg.find("cut off"), std::string::npos);
  EXPECT_EQ(svg.find(">1e+06<"), std::string::npos);  // no such tick
  EXPECT_NE(svg.find("mean 1e+06"), std::string::npos);
}

TEST(CostPlotTest, OneValueAndNoneGiveAPlotAndNone) {
  EXPECT_EQ(ToSvg({"t", "x", "y", {}}), "");
  EXPECT_EQ(ToSvg({"t", "x", "y", {{"a", "best", {{3, 0.0}}}}}).find("nan"), std::string::npos);
}

}  // namespace
}  // namespace pregrasp
