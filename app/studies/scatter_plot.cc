#include "app/studies/scatter_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pregrasp {
namespace {

constexpr double kSize = 480.0, kLeft = 64.0, kBottom = 56.0, kTop = 40.0, kRight = 20.0;

// 1, 2 or 5 times a power of ten, at most eight of which reach `most`.
double ChooseTick(double most) {
  const double power = std::pow(10.0, std::floor(std::log10(most / 8.0)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (8.0 * factor * power >= most) return factor * power;
  }
  return 10.0 * power;
}

std::string Escape(const std::string& text) {
  std::string out;
  for (const char c : text) {
    out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  }
  return out;
}

std::string Text(double x, double y, const char* more, const std::string& text) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>\n", x, y, more, Escape(text));
}

std::string Line(double x1, double y1, double x2, double y2, const char* stroke) {
  return fmt::format(
      "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\"/>\n", x1, y1, x2,
      y2, stroke);
}

}  // namespace

std::string ToSvg(const ScatterPlot& plot) {
  double most = 0.0;
  for (const auto& [x, y] : plot.points) most = std::max({most, x, y});
  const double tick = ChooseTick(std::max(most, 1e-9));
  const int ticks = static_cast<int>(std::ceil(std::max(most, 1e-9) / tick));
  const double end = ticks * tick;
  const double right = kSize - kRight, low = kSize - kBottom;
  const auto x_of = [&](double x) { return kLeft + x / end * (right - kLeft); };
  const auto y_of = [&](double y) { return low - y / end * (low - kTop); };
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{0:.0f}\" "
      "font-family=\"sans-serif\" font-size=\"13\" fill=\"#333\">\n"
      "<rect width=\"{0:.0f}\" height=\"{0:.0f}\" fill=\"#fff\"/>\n",
      kSize);
  for (int i = 0; i <= ticks; ++i) {
    const double at = i * tick;
    svg += Line(x_of(at), kTop, x_of(at), low, "#e4e4e4") +
           Line(kLeft, y_of(at), right, y_of(at), "#e4e4e4") +
           Text(x_of(at), low + 18.0, "text-anchor=\"middle\"", fmt::format("{:g}", at)) +
           Text(kLeft - 8.0, y_of(at) + 4.0, "text-anchor=\"end\"", fmt::format("{:g}", at));
  }
  svg += Line(kLeft, low, right, kTop, "#999");
  for (const auto& [x, y] : plot.points) {
    svg += fmt::format(
        "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" fill=\"#2b6cb0\" fill-opacity=\"0.7\"/>\n",
        x_of(x), y_of(y));
  }
  const double middle = 0.5 * (kTop + low);
  svg += Text(kLeft, 24.0, "font-size=\"15\" font-weight=\"bold\"", plot.title) +
         Text(0.5 * (kLeft + right), kSize - 14.0, "text-anchor=\"middle\"", plot.x_label) +
         fmt::format(
             "<text transform=\"translate(18 {:.1f}) rotate(-90)\" text-anchor=\"middle\">{}"
             "</text>\n",
             middle, Escape(plot.y_label));
  return svg + "</svg>\n";
}

}  // namespace pregrasp
