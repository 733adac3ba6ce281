#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/graph/contact_graph.h"
#include "app/recording/loaded_run.h"

namespace pregrasp {

/// The contact graph as it was at a step: scores and pruning from what the steps before it
/// recorded. None before it was scored.
/// @param top_percent  the paper's M, where no step has pruned by it yet.
std::optional<ContactGraph> RestoreGraph(const StepFacts& step, const FactsSource& steps,
                                         double top_percent);

/// The same at the end of a finished run.
std::optional<ContactGraph> RestoreGraph(const LoadedRun& run);

/// The graph as assets/graph.js reads it: the mesh; scores, ranks, verdict and why (DescribeReason)
/// of every node.
nlohmann::ordered_json PageGraph(const ContactGraph& graph);

/// The graph as a picture that needs no script: a square a kept node, in the row of its thumb's
/// triangle and the column of its index finger's.
std::string GraphSvg(const ContactGraph& graph);
/// Its view box.
inline constexpr double kGraphWidth = 532.0, kGraphHeight = 522.0;
/// How to read it.
const char* GraphWords();
/// The highest score s_c of its nodes, which has the brightest colour.
double HighestScore(const ContactGraph& graph);

/// Sentences that differ in numbers alone, so that thousands of them take little room: each
/// sentence is the number of its pattern, followed by the numbers that stand at the pattern's "#".
struct PackedSentences {
  std::vector<std::string> patterns;
  std::vector<std::vector<std::string>> sentences;
};
PackedSentences PackSentences(const std::vector<std::string>& sentences);

}  // namespace pregrasp
