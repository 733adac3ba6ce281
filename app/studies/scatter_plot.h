#pragma once

#include <string>
#include <utility>
#include <vector>

namespace pregrasp {

/// Points of two measures on the same scale, from zero, with the diagonal where both are alike.
struct ScatterPlot {
  std::string title, x_label, y_label;
  std::vector<std::pair<double, double>> points;
};

/// The plot as a picture of 480 by 480; the same plot gives the same bytes.
std::string ToSvg(const ScatterPlot& plot);

}  // namespace pregrasp
