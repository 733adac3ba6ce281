#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/recording/loaded_run.h"

namespace pregrasp {

/// Lines over one axis, as an SVG that takes its colours from the page around it.
struct CostPlot {
  static constexpr double kWidth = 640.0, kHeight = 260.0;  ///< of its view box
  struct Line {
    std::string name;
    std::string style;  ///< a class of assets/figures.css: "best", "mean"
    std::vector<std::pair<double, double>> points;
  };
  std::string title, x_label, y_label;
  std::vector<Line> lines;
};

/// The largest values may lie above the plot, where they would press the rest flat: it shows what
/// nine tenths of all points need, and says so.
std::string ToSvg(const CostPlot& plot);

/// The costs of each path that a run has optimised; where somebody went back and on otherwise, a
/// line for each end.
std::vector<CostPlot> MakeCostPlots(const LoadedRun& run);

}  // namespace pregrasp
