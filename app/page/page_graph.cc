#include "app/page/page_graph.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include "app/page/html_text.h"
#include "app/page/page_space.h"
#include "app/page/run_steps.h"
#include "app/pictures/words.h"
#include "render/palette.h"

namespace pregrasp {
namespace {

using GraphJson = nlohmann::ordered_json;

// One letter a node for the page's script.
char VerdictLetter(NodeReason::Verdict verdict) {
  using Verdict = NodeReason::Verdict;
  switch (verdict) {
    case Verdict::kKeptByContext:
      return 'c';
    case Verdict::kKeptByFree:
      return 'n';
    case Verdict::kKeptByBoth:
      return 'b';
    case Verdict::kPruned:
      return 'p';
    default:
      return '-';
  }
}

double Rounded4(double value) { return std::round(value * 1e4) / 1e4; }

bool IsDigit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

}  // namespace

std::optional<ContactGraph> RestoreGraph(const StepFacts& step, const FactsSource& steps,
                                         double top_percent) {
  const auto* scores = steps.FindBefore<ScoreFacts>(step);
  const auto* mesh = steps.FindBefore<MeshFacts>(step);
  if (scores == nullptr || mesh == nullptr) return std::nullopt;
  const auto* pruning = steps.FindBefore<PruneFacts>(step);
  ContactGraphConfig config;
  config.samples = scores->samples;
  config.top_percent = pruning != nullptr ? pruning->top_percent : top_percent;
  ContactGraph graph(mesh->mesh, config);
  graph.TakeScores({scores->s_c, scores->s_n, scores->occluded});
  if (pruning == nullptr) return graph;
  // What a cut under way has done; those before it were done in full.
  const auto prune_until = [&](GraphStage stage) {
    while (graph.stage() < stage) graph.PruneStep();
  };
  const bool under_way = pruning->nodes_done > 0;
  if (pruning->complete) {
    graph.Prune();
  } else if (pruning->cut == "context") {
    if (!under_way) prune_until(GraphStage::kPrunedContext);
  } else {
    prune_until(pruning->cut == "free" && under_way ? GraphStage::kPrunedContext
                                                    : GraphStage::kPrunedFree);
  }
  if (under_way) graph.PruneStep(pruning->nodes_done);
  return graph;
}

std::optional<ContactGraph> RestoreGraph(const LoadedRun& run) {
  const nlohmann::json::json_pointer percent("/configuration/graph/top_percent");
  return RestoreGraph(RunSteps(run).end(), run,
                      run.manifest.value(percent, ContactGraphConfig{}.top_percent));
}

PackedSentences PackSentences(const std::vector<std::string>& sentences) {
  PackedSentences packed;
  std::map<std::string, std::size_t> known;
  for (const std::string& sentence : sentences) {
    std::string pattern;
    std::vector<std::string> numbers;
    for (std::size_t i = 0; i < sentence.size();) {
      std::size_t end = i;
      while (end < sentence.size() && (IsDigit(sentence[end]) ||
                                       (sentence[end] == '.' && end > i &&
                                        end + 1 < sentence.size() && IsDigit(sentence[end + 1])))) {
        ++end;
      }
      if (end > i) {
        numbers.push_back(sentence.substr(i, end - i));
        pattern += '#';
        i = end;
      } else if (sentence[i] == '#') {  // stands for itself
        numbers.emplace_back("#");
        pattern += sentence[i++];
      } else {
        pattern += sentence[i++];
      }
    }
    const auto [at, is_new] = known.emplace(pattern, packed.patterns.size());
    if (is_new) packed.patterns.push_back(pattern);
    numbers.insert(numbers.begin(), std::to_string(at->second));
    packed.sentences.push_back(std::move(numbers));
  }
  return packed;
}

GraphJson PageGraph(const ContactGraph& graph) {
  GraphJson vertices = GraphJson::array(), faces = GraphJson::array(), s_c = GraphJson::array(),
            s_n = GraphJson::array(), rank_c = GraphJson::array(), rank_n = GraphJson::array(),
            occluded = GraphJson::array(), texts = GraphJson::array(), ramp = GraphJson::array();
  const TriangleMesh& mesh = graph.mesh();
  for (Eigen::Index i = 0; i < mesh.V.rows(); ++i) {
    for (int axis = 0; axis < 3; ++axis)
      vertices.push_back(std::round(mesh.V(i, axis) * 1e5) / 1e5);
  }
  for (Eigen::Index f = 0; f < mesh.F.rows(); ++f) {
    for (int k = 0; k < 3; ++k) faces.push_back(mesh.F(f, k));
  }
  std::string verdicts;
  std::vector<std::string> sentences;
  NodeReason any;
  for (const ContactNode& node : graph.nodes()) {
    const NodeReason reason = graph.Why(node.id);
    any = reason;
    s_c.push_back(Rounded4(node.s_c));
    s_n.push_back(Rounded4(node.s_n));
    rank_c.push_back(node.rank_c);
    rank_n.push_back(node.rank_n);
    occluded.push_back(Rounded4(node.occluded));
    verdicts += VerdictLetter(reason.verdict);
    sentences.push_back(DescribeReason(reason));
  }
  const PackedSentences packed = PackSentences(sentences);
  for (const auto& sentence : packed.sentences) {
    std::string text;
    for (const std::string& number : sentence) text += (text.empty() ? "" : " ") + number;
    texts.push_back(text);
  }
  constexpr int kColors = 33;
  for (int i = 0; i < kColors; ++i) ramp.push_back(CssColor(ScoreColor(i / (kColors - 1.0))));
  return {{"triangles", graph.num_triangles()},
          {"V", std::move(vertices)},
          {"F", std::move(faces)},
          {"s_c", std::move(s_c)},
          {"s_n", std::move(s_n)},
          {"rank_c", std::move(rank_c)},
          {"rank_n", std::move(rank_n)},
          {"occluded", std::move(occluded)},
          {"verdict", verdicts},
          {"kept_each", any.num_kept_each},
          {"threshold_c", any.threshold_c},
          {"threshold_n", any.threshold_n},
          {"patterns", packed.patterns},
          {"why", std::move(texts)},
          {"ramp", std::move(ramp)},
          {"thumb", CssColor(FingerColor(Finger::kThumb))},
          {"index", CssColor(FingerColor(Finger::kIndex))},
          {"plain", CssColor(NeutralColor())}};
}

double HighestScore(const ContactGraph& graph) {
  double highest = 1e-12;
  for (const ContactNode& node : graph.nodes()) highest = std::max(highest, node.s_c);
  return highest;
}

const char* GraphWords() {
  return "A square is a contact state: the thumb on the triangle of its row, the index finger on "
         "that of its column. Colours are scores with the surroundings, dark low and bright high; "
         "states that were pruned are left out. Those with a dark orange rim were kept for their "
         "score without surroundings alone: a path may not begin with these. A path goes from a "
         "state to one in the same row or column, where one finger stays.";
}

std::string GraphSvg(const ContactGraph& graph) {
  constexpr double kSide = 480.0, kLeft = 50.0, kTop = 40.0;
  const int count = graph.num_triangles();
  const double cell = kSide / count, highest = HighestScore(graph);
  std::string svg = fmt::format(
      "<svg class=\"matrix\" viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" aria-label=\"{} of {} "
      "contact states are kept: rows are the thumb's triangles, columns the index finger's\">\n"
      "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" class=\"ground\"/>\n",
      kGraphWidth, kGraphHeight, graph.kept().size(), graph.nodes().size(), kLeft, kTop, kSide,
      kSide);
  for (const int id : graph.kept()) {
    const ContactNode& node = graph.nodes()[id];
    svg += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"{}/>\n",
        kLeft + node.index * cell, kTop + node.thumb * cell, cell, cell,
        CssColor(ScoreColor(node.s_c / highest)), node.initial ? "" : " class=\"later\"");
  }
  constexpr int kMostTicks = 12;
  const int every = count <= kMostTicks ? 1 : 5;
  for (int i = 0; i < count; i += every) {
    const double middle = (i + 0.5) * cell;
    svg += fmt::format(
        "<text class=\"tick\" x=\"{:.1f}\" y=\"{:.0f}\" text-anchor=\"middle\">{}</text>"
        "<text class=\"tick\" x=\"{:.0f}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n",
        kLeft + middle, kTop - 6.0, i, kLeft - 6.0, kTop + middle + 3.5, i);
  }
  svg += fmt::format(
      "<text x=\"{:.0f}\" y=\"15\" text-anchor=\"middle\">index finger's triangle</text>"
      "<text transform=\"translate(16 {:.0f}) rotate(-90)\" text-anchor=\"middle\">thumb's "
      "triangle</text>\n",
      kLeft + 0.5 * kSide, kTop + 0.5 * kSide);
  return svg + "</svg>\n";
}

}  // namespace pregrasp
