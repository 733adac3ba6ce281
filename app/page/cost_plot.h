#pragma once

#include <string>
#include <utility>
#include <vector>

namespace pregrasp {

/// Lines over one axis, as an SVG that takes its colours from the page around it.
struct CostPlot {
  struct Line {
    std::string name;
    std::string style;  ///< a class of assets/page.css: "best", "mean"
    std::vector<std::pair<double, double>> points;
  };
  std::string title, x_label, y_label;
  std::vector<Line> lines;
};

/// The largest values may lie above the plot, where they would press the rest flat: it shows what
/// nine tenths of all points need, and says so.
std::string ToSvg(const CostPlot& plot);

}  // namespace pregrasp
