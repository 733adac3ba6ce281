#include "app/page/figure.h"

#include <fmt/format.h>

#include <vector>

#include "app/core/error.h"
#include "app/page/cost_plot.h"
#include "app/page/html_text.h"
#include "app/page/page.h"
#include "app/page/page_graph.h"
#include "app/page/page_space.h"
#include "app/recording/checked_file.h"
#include "render/caption_card.h"
#include "render/font.h"
#include "render/palette.h"

namespace pregrasp {
namespace {

constexpr double kMargin = 16.0, kLine = 17.0;

// A declaration of the page's light colours: "--line: #d9d6cf" gives "#d9d6cf".
std::string FindColor(const std::string& name) {
  const std::string css = PageAsset("page.css");
  const std::size_t at = css.find("--" + name + ": ") + name.size() + 4;
  return css.substr(at, css.find(';', at) - at);
}

// The style of the page's drawings, with colours as values: few programs but browsers know
// variables.
std::string FigureStyle() {
  std::string css = PageAsset("figures.css");
  for (std::size_t at = css.find("var(--"); at != std::string::npos; at = css.find("var(--", at)) {
    const std::size_t end = css.find(')', at);
    css.replace(at, end + 1 - at, FindColor(css.substr(at + 6, end - at - 6)));
  }
  return css +
         "svg text { font-family: \"DejaVu Sans\", Helvetica, Arial, sans-serif; }\n"
         "svg .title { font-size: 14px; font-weight: bold; }\n";
}

std::string Text(double x, double y, const std::string& text) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", x, y, EscapeHtml(text));
}

std::string Title(const std::string& text, double y) {
  return fmt::format("<text class=\"title\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", kMargin, y,
                     EscapeHtml(text));
}

// A drawing at a place of another one, in its own size.
std::string Nest(const std::string& svg, double y, double width, double height) {
  const std::string tag = "<svg ";
  return fmt::format("<svg x=\"{:.0f}\" y=\"{:.0f}\" width=\"{:.0f}\" height=\"{:.0f}\" ", kMargin,
                     y, width, height) +
         svg.substr(tag.size());
}

std::string Document(double width, double height, const std::string& content) {
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "viewBox=\"0 0 {0:.0f} {1:.0f}\" color=\"{2}\">\n<style>\n{3}</style>\n"
      "<rect width=\"{0:.0f}\" height=\"{1:.0f}\" fill=\"#ffffff\"/>\n{4}</svg>\n",
      width, height, FindColor("ink"), FigureStyle(), content);
}

std::string NameOf(const LoadedRun& run) {
  return fmt::format("{}, seed {}", run.scene.name, run.summary.seed);
}

std::string CostFigure(const LoadedRun& run) {
  const std::vector<CostPlot> plots = MakeCostPlots(run);
  if (plots.empty()) {
    throw InputError(run.directory.string(), "", "a run with iterations of a plan", "one without");
  }
  std::string content;
  double y = kMargin;
  for (const CostPlot& plot : plots) {
    content += Title(NameOf(run) + ": " + plot.title, y + kLine);
    y += 2.0 * kLine;
    content += Nest(ToSvg(plot), y, CostPlot::kWidth, CostPlot::kHeight);
    y += CostPlot::kHeight + kMargin;
  }
  return Document(CostPlot::kWidth + 2.0 * kMargin, y, content);
}

// What the colours of the squares mean, beside them.
std::string ScoreBar(double x, double y, double highest) {
  constexpr double kWide = 16.0, kHigh = 240.0;
  constexpr int kColors = 60;
  std::string bar = Text(x, y - 14.0, "score s_c");
  for (int i = 0; i < kColors; ++i) {
    bar += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.2f}\" width=\"{}\" height=\"{:.2f}\" fill=\"{}\"/>\n", x,
        y + kHigh * (kColors - 1 - i) / kColors, kWide, kHigh / kColors + 0.4,
        CssColor(ScoreColor((i + 0.5) / kColors)));
  }
  for (const double share : {0.0, 0.5, 1.0}) {
    bar += Text(x + kWide + 6.0, y + (1.0 - share) * kHigh + 4.0,
                fmt::format("{:.3f}", share * highest));
  }
  return bar;
}

std::string GraphFigure(const LoadedRun& run) {
  const std::optional<ContactGraph> graph = RestoreGraph(run);
  if (!graph || graph->stage() == GraphStage::kMeshed) {
    throw InputError(run.directory.string(), "", "a run with a contact graph that was scored",
                     "one without");
  }
  constexpr double kBarWidth = 96.0, kType = 12.0;
  const double width = kGraphWidth + kBarWidth + 3.0 * kMargin;
  std::string content = Title(fmt::format("{}: {} of {} contact states kept", NameOf(run),
                                          graph->kept().size(), graph->nodes().size()),
                              kMargin + kLine);
  const double top = kMargin + 2.0 * kLine;
  content += Nest(GraphSvg(*graph), top, kGraphWidth, kGraphHeight);
  content += ScoreBar(kGraphWidth + 2.0 * kMargin, top + 48.0, HighestScore(*graph));
  FontSet fonts;
  double y = top + kGraphHeight + 0.5 * kMargin;
  for (const std::string& line :
       WrapText(fonts, FontFace::kSans, kType, GraphWords(), width - 2.0 * kMargin)) {
    y += kLine;
    content += Text(kMargin, y, line);
  }
  return Document(width, y + kMargin, content);
}

}  // namespace

std::string MakeFigure(const LoadedRun& run, const std::string& what) {
  if (what == "costs") return CostFigure(run);
  if (what == "graph") return GraphFigure(run);
  throw InputError("--what", "", "costs or graph", what.empty() ? "nothing" : '"' + what + '"');
}

void WriteFigure(const LoadedRun& run, const std::string& what, const std::filesystem::path& file) {
  WriteFile(file, MakeFigure(run, what));
}

}  // namespace pregrasp
