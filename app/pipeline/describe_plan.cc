#include "app/pipeline/describe_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace pregrasp {
namespace {

const ContactNode& BestBy(const ContactGraph& graph, int ContactNode::*rank) {
  return *std::min_element(
      graph.nodes().begin(), graph.nodes().end(),
      [rank](const ContactNode& a, const ContactNode& b) { return a.*rank < b.*rank; });
}

std::string NodeText(const ContactNode& node) {
  return fmt::format("node {} (thumb {}, index {})", node.id, node.thumb, node.index);
}

// What decided at a cut through nodes of equal score; `other` is what was looked at then.
std::string TieText(int num_tied, TieRule rule, const char* other) {
  if (rule == TieRule::kNone) return "";
  const std::string tied = fmt::format("; {} states score exactly that, of which ", num_tied);
  return rule == TieRule::kScores
             ? tied + fmt::format("those with the higher score {} stay", other)
             : tied + "some, alike in both scores, stay for their lower numbers alone";
}

const char* EndText(MppiEnd end) {
  switch (end) {
    case MppiEnd::kNone:
      return "";
    case MppiEnd::kPatience:
      return " The best cost has stopped falling.";
    case MppiEnd::kLimit:
      return " The iterations are used up.";
  }
  return "";
}

double Millimetres(double metres) { return 1e3 * metres; }

}  // namespace

std::vector<std::string> DescribeMesh(const ContactGraph& graph) {
  return {fmt::format("The object's surface in {} triangles. A contact state puts the thumb "
                      "somewhere on one of them and the index finger on another, or the same.",
                      graph.num_triangles()),
          fmt::format("contact states\t{}", graph.nodes().size())};
}

std::vector<std::string> DescribeScores(const ContactGraph& graph) {
  const ContactNode& context = BestBy(graph, &ContactNode::rank_c);
  const ContactNode& free = BestBy(graph, &ContactNode::rank_n);
  return {
      fmt::format(
          "How likely does a contact state lead to a grasp? The learned score of each, mean "
          "of {} placements of thumb, index finger and both; a triangle has the colour of "
          "the best state that uses it.",
          graph.config().samples),
      fmt::format("best here\t{:.3f}, {}", context.s_c, NodeText(context)),
      fmt::format("best alone\t{:.3f}, {}", free.s_n, NodeText(free)),
  };
}

std::vector<std::string> DescribePruning(const ContactGraph& graph) {
  const auto count = [&](auto chosen) {
    return std::count_if(graph.nodes().begin(), graph.nodes().end(), chosen);
  };
  const NodeReason any = graph.Why(0);
  const double percent = graph.config().top_percent;
  const long initial = count([](const ContactNode& node) { return node.initial; });
  const long kept = count([](const ContactNode& node) { return node.kept; });
  std::vector<std::string> lines;
  // The step that was taken last, or is under way.
  GraphStage step = graph.stage();
  if (graph.num_done() > 0) step = static_cast<GraphStage>(static_cast<int>(step) + 1);
  switch (step) {
    case GraphStage::kPrunedContext:
      lines = {
          fmt::format("The {:g} % with the best score among the surroundings stay: with one of "
                      "these a path may begin.",
                      percent),
          fmt::format("threshold\t{:.3f}", any.threshold_c)};
      break;
    case GraphStage::kPrunedFree:
      lines = {fmt::format("So do the {:g} % with the best score without surroundings: they may "
                           "come later, when the object has moved.",
                           percent),
               fmt::format("threshold\t{:.3f}", any.threshold_n)};
      break;
    default:
      lines = {
          "States that share a triangle are connected: one finger stays while the other "
          "changes its place.",
          fmt::format("edges\t{}", graph.num_edges())};
  }
  if (graph.num_done() > 0) {
    lines.push_back(fmt::format("so far\t{} nodes of this step", graph.num_done()));
  }
  lines.push_back(fmt::format("may begin\t{}", initial));
  lines.push_back(fmt::format("kept\t{} of {}", kept, graph.nodes().size()));
  return lines;
}

std::string DescribeReason(const NodeReason& reason) {
  const ContactNode& node = reason.node;
  using Verdict = NodeReason::Verdict;
  if (reason.verdict == Verdict::kNotScored) return NodeText(node) + " has no score yet";
  const auto by = [&](const char* where, double score, int rank, double threshold,
                      const std::string& tie) {
    return fmt::format("{} it scores {:.3f}, rank {} of {} (the best {} stay, down to {:.3f}{})",
                       where, score, rank, reason.num_nodes, reason.num_kept_each, threshold, tie);
  };
  std::string text = NodeText(node);
  text += reason.verdict == Verdict::kPruned          ? " is pruned: "
          : reason.verdict == Verdict::kScored        ? " is scored and not decided on: "
          : reason.verdict == Verdict::kKeptByContext ? " is kept for its score here: "
          : reason.verdict == Verdict::kKeptByFree    ? " is kept for its score alone: "
                                                      : " is kept for both its scores: ";
  text += by("here", node.s_c, node.rank_c, reason.threshold_c,
             TieText(reason.num_tied_c, reason.rule_c, "without surroundings")) +
          "; ";
  text += by("without surroundings", node.s_n, node.rank_n, reason.threshold_n,
             TieText(reason.num_tied_n, reason.rule_n, "here"));
  if (node.occluded > 0.0) {
    text += fmt::format("; no fingertip can be at {:.0f} % of its contacts", 100 * node.occluded);
  }
  return text;
}

std::vector<std::string> DescribePath(const ContactGraph& graph, const ContactPath& path) {
  std::vector<std::string> lines = {
      fmt::format("Path {}: of all paths of {} contact states the one with rank {} by the sum of "
                  "its scores.",
                  path.rank, path.nodes.size(), path.rank),
      fmt::format("score\t{:.3f}", path.score)};
  if (path.num_tied > 1) {
    lines[0] += fmt::format(" {}{} paths have exactly this score; {}.", path.num_tied,
                            path.num_tied == kMostTied ? " or more" : "",
                            path.rule == TieRule::kScores
                                ? "the ranks of their states decide among them"
                                : "the order of some is that of their states' numbers");
  }
  for (std::size_t i = 0; i < path.nodes.size(); ++i) {
    const ContactNode& node = graph.nodes().at(path.nodes[i]);
    lines.push_back(fmt::format("stage {}\t{:.3f}, thumb {}, index {}", i + 1, path.terms[i],
                                node.thumb, node.index));
  }
  return lines;
}

std::vector<std::string> DescribeIteration(const MppiState& state) {
  const PlanCost& best = state.best;
  std::vector<std::string> lines = {
      fmt::format("Iteration {}: {} plans near the mean were simulated; the ghosts are where the "
                  "best of them leave the object, and the mean moves towards them.{}",
                  state.iteration, state.samples.size(), EndText(state.end)),
      fmt::format("best cost\t{:.3f}", state.best_cost),
      fmt::format("mean cost\t{:.3f}", state.mean_history.back())};
  for (std::size_t i = 0; i < best.stage_scores.size(); ++i) {
    lines.push_back(fmt::format("score, stage {}\t{:.3f}", i + 1, best.stage_scores[i]));
  }
  lines.push_back(fmt::format("score, end\t{:.3f}", best.final_score));
  const std::pair<const char*, double> terms[] = {
      {"no contact", best.no_contact},   {"slip", best.slip},   {"effort", best.effort},
      {"unrest", best.unrest},           {"speed", best.speed}, {"tip overlap", best.tip_overlap},
      {"tip spacing", best.tip_spacing}, {"fall", best.fall}};
  for (const auto& [name, value] : terms) {
    if (value >= 5e-4) lines.push_back(fmt::format("cost of {}\t{:.3f}", name, value));
  }
  return lines;
}

std::vector<std::string> DescribeCertificate(const Scene& scene, const Certificate& certificate,
                                             const ReleaseResult& release) {
  std::vector<std::string> lines;
  if (certificate.certified) {
    lines.push_back(fmt::format(
        "The best plan, simulated again by Simbody and at half the time step, leaves the {} where "
        "it stays. Without the fingers it {}, so they {}.",
        scene.object().name, release.stays ? "stays too" : "would move",
        release.stays ? "may leave" : "must keep pressing"));
  } else {
    std::string reasons;
    for (const CertifyReason reason : certificate.reasons) {
      reasons += (reasons.empty() ? "" : "; ") + std::string(CertifyReasonText(reason));
    }
    lines.push_back("Not certified: " + reasons + ".");
  }
  lines.push_back(fmt::format("moves in {:g} s\t{:.2f} mm, {:.2f} deg", certificate.hold_seconds,
                              Millimetres(certificate.hold_shift), certificate.hold_turn_deg));
  lines.push_back(fmt::format("at half the step\t{:.2f} mm, {:.2f} deg elsewhere",
                              Millimetres(certificate.step_shift), certificate.step_turn_deg));
  lines.push_back(fmt::format("moves if released\t{:.1f} mm, {:.1f} deg",
                              Millimetres(release.shift), release.turn_deg));
  lines.push_back(fmt::format("largest force\t{:.2f} N", certificate.full.max_force));
  return lines;
}

std::vector<std::string> DescribeGrasp(const GraspWorld& world, const CompletedGrasp& grasp) {
  std::vector<std::string> lines = {Explain(grasp.result, world)};
  if (grasp.moved > 0.0) {
    lines.push_back(fmt::format("contacts moved by\t{:.1f} mm", Millimetres(grasp.moved)));
  }
  if (grasp.result.wrench && grasp.feasible()) {
    for (std::size_t i = 0; i < grasp.result.contacts.size(); ++i) {
      lines.push_back(
          fmt::format("{}\t{:.2f} N", FingerName(grasp.result.contacts[i].finger),
                      grasp.result.wrench->forces.row(static_cast<Eigen::Index>(i)).norm()));
    }
  }
  if (grasp.result.kinematics) {
    lines.push_back(fmt::format("hand clearance\t{:.1f} mm",
                                Millimetres(grasp.result.kinematics->ik.clearance)));
  }
  return lines;
}

std::vector<std::string> DescribeFrame(const MotionFrameTask& task, const MotionFrame& frame) {
  std::string touching;
  for (int f = 0; f < kNumFingers; ++f) {
    if (!task.contacts[f].on) continue;
    touching += (touching.empty() ? "" : ", ") + std::string(FingerName(static_cast<Finger>(f)));
  }
  const bool failed = frame.rung == LooseningRung::kFailed;
  std::string verdict = "The hand is free of overlaps.";
  if (failed) verdict = "No hand pose was found; this is the best attempt.";
  if (!failed && frame.rung != LooseningRung::kNone) {
    verdict = fmt::format("Only with a demand loosened: {}.", LooseningRungName(frame.rung));
  }
  return {
      fmt::format("{}: {}. {}", MotionPhaseName(task.phase),
                  touching.empty() ? "no finger touches" : touching + " on the object", verdict),
      fmt::format("clearance\t{:.2f} mm", Millimetres(frame.clearance)),
      fmt::format("tip error\t{:.2f} mm", Millimetres(frame.tip_error))};
}

std::string DescribeStage(const ContactGraph& graph, const ContactPath& path, const WorldPlan& plan,
                          int stage) {
  const ContactNode& node = graph.nodes().at(path.nodes.at(stage));
  std::string text;
  for (int f = 0; f < kNumPlanningFingers; ++f) {
    if (!plan.stages.at(stage)[f].on) continue;
    text += fmt::format("{}{} on {}", text.empty() ? "" : ", ", FingerName(static_cast<Finger>(f)),
                        f == 0 ? node.thumb : node.index);
  }
  return text.empty() ? "no finger" : text;
}

}  // namespace pregrasp
