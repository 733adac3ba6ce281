#include "app/page/cost_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "app/page/html_text.h"

namespace pregrasp {
namespace {

constexpr double kWidth = CostPlot::kWidth, kHeight = CostPlot::kHeight, kLeft = 62.0,
                 kRight = 110.0, kTop = 30.0, kBottom = 44.0;

struct PlotRange {
  double low = 0.0, high = 1.0, tick = 1.0;
};

// Between whole ticks of 1, 2 or 5 times a power of ten, four to eight of them.
PlotRange ChooseRange(double low, double high) {
  const double span = std::max({high - low, 1e-9, 1e-6 * std::abs(high)});
  const double power = std::pow(10.0, std::floor(std::log10(span / 4.0)));
  double tick = power;
  for (const double factor : {1.0, 2.0, 5.0, 10.0}) {
    tick = factor * power;
    if (span / tick <= 7.0) break;
  }
  return {tick * std::floor(low / tick), tick * std::ceil(high / tick), tick};
}

std::string PlotText(double x, double y, const char* anchor, const std::string& text) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor,
                     EscapeHtml(text));
}

}  // namespace

std::string ToSvg(const CostPlot& plot) {
  std::vector<double> x, y;
  for (const CostPlot::Line& line : plot.lines) {
    for (const auto& [px, py] : line.points) {
      x.push_back(px);
      y.push_back(py);
    }
  }
  if (x.empty()) return "";
  std::sort(y.begin(), y.end());
  const auto high_at = static_cast<std::size_t>(std::ceil(0.9 * static_cast<double>(y.size() - 1)));
  // Cut only what is far above the rest.
  const double middle_span = y[high_at] - y.front();
  const bool cut = y.back() - y.front() > 2.0 * middle_span && middle_span > 0.0;
  const PlotRange up = ChooseRange(y.front(), cut ? y[high_at] : y.back());
  const double x_low = *std::min_element(x.begin(), x.end());
  const double x_high = std::max(*std::max_element(x.begin(), x.end()), x_low + 1.0);
  const double right = kWidth - kRight, bottom = kHeight - kBottom;
  const auto x_of = [&](double at) {
    return kLeft + (at - x_low) / (x_high - x_low) * (right - kLeft);
  };
  const auto y_of = [&](double at) {
    return bottom -
           (std::min(at, up.high) - up.low) / std::max(up.high - up.low, 1e-12) * (bottom - kTop);
  };
  std::string svg = fmt::format(
      "<svg class=\"plot\" viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" aria-label=\"{}\">\n"
      "<title>{}</title>\n",
      kWidth, kHeight, EscapeHtml(plot.title), EscapeHtml(plot.title));
  const int ticks = static_cast<int>(std::lround((up.high - up.low) / up.tick));
  for (int i = 0; i <= ticks; ++i) {
    const double at = up.low + i * up.tick;
    svg += fmt::format(
        "<line class=\"grid\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>\n", kLeft,
        y_of(at), right, y_of(at));
    svg += PlotText(kLeft - 8.0, y_of(at) + 4.0, "end",
                    fmt::format("{:.6g}", std::abs(at) < 1e-9 * up.tick ? 0.0 : at));
  }
  const double x_tick = std::max(1.0, std::ceil((x_high - x_low) / 10.0));
  for (int i = 0; x_low + i * x_tick <= x_high; ++i) {
    const double at = x_low + i * x_tick;
    svg += PlotText(x_of(at), bottom + 18.0, "middle", fmt::format("{:.0f}", at));
  }
  double name_y = -1e9;
  for (const CostPlot::Line& line : plot.lines) {
    if (line.points.empty()) continue;
    std::string points;
    for (const auto& [px, py] : line.points) {
      points += fmt::format("{:.1f},{:.1f} ", x_of(px), y_of(py));
    }
    svg += fmt::format("<polyline class=\"{}\" points=\"{}\"/>\n", line.style, points);
    for (const auto& [px, py] : line.points) {
      svg += fmt::format(
          "<circle class=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.6\"><title>{}</title></circle>\n",
          line.style, x_of(px), y_of(py),
          EscapeHtml(fmt::format("{} {:.0f}: {} {:.4g}", plot.x_label, px, line.name, py)));
    }
    if (line.name.empty()) continue;
    const auto& [last_x, last_y] = line.points.back();
    double at = y_of(last_y) + 4.0;
    if (std::abs(at - name_y) < 14.0) at = name_y + (at < name_y ? -14.0 : 14.0);
    name_y = at;
    svg += PlotText(x_of(last_x) + 8.0, at, "start", line.name);
  }
  svg += PlotText(kLeft, 16.0, "start",
                  plot.y_label + (cut ? ", what is higher cut off at the upper edge" : ""));
  svg += PlotText(0.5 * (kLeft + right), kHeight - 6.0, "middle", plot.x_label);
  return svg + "</svg>\n";
}

std::vector<CostPlot> MakeCostPlots(const LoadedRun& run) {
  // By path; where somebody went back and on otherwise, a line for each end.
  std::map<int, std::vector<std::vector<const IterationFacts*>>> of_path;
  std::map<std::string, bool> goes_on;
  for (const StepFacts& step : run.steps) {
    if (step.command.verb == Verb::kIterate) goes_on[step.command.node] = true;
  }
  for (const StepFacts& step : run.steps) {
    if (step.command.verb != Verb::kIterate || goes_on.count(step.id) > 0) continue;
    std::vector<const IterationFacts*> line;
    for (const StepFacts* at = &step; at->command.verb == Verb::kIterate;
         at = &run.Get(at->command.node)) {
      line.push_back(&std::get<IterationFacts>(at->details));
    }
    std::reverse(line.begin(), line.end());
    of_path[line.front()->path].push_back(std::move(line));
  }
  std::vector<CostPlot> plots;
  for (const auto& [path, lines] : of_path) {
    CostPlot plot;
    plot.title = fmt::format("Costs of the plans along path {}", path);
    plot.x_label = "iteration";
    plot.y_label = "cost";
    for (const auto& line : lines) {
      CostPlot::Line best{"best so far", "best", {}}, mean{"mean", "mean", {}};
      double least = 0.0;
      for (const IterationFacts* facts : line) {
        least = best.points.empty() ? facts->best_cost : std::min(least, facts->best_cost);
        best.points.emplace_back(facts->iteration, least);
        mean.points.emplace_back(facts->iteration, facts->mean_cost);
      }
      plot.lines.push_back(std::move(best));
      plot.lines.push_back(std::move(mean));
    }
    plots.push_back(std::move(plot));
  }
  return plots;
}

}  // namespace pregrasp
