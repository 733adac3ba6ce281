#include <fmt/format.h>

#include <algorithm>

#include "app/graph/contact_path.h"
#include "app/graph/path_explorer.h"
#include "app/pictures/words.h"

namespace pregrasp {
namespace {

using Lines = std::vector<std::string>;

template <typename Node>
std::string NodeText(const Node& node) {
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

std::string Join(const std::vector<std::string>& texts, const char* separator) {
  std::string joined;
  for (const std::string& text : texts) joined += (joined.empty() ? "" : separator) + text;
  return joined;
}

// "tip_spacing" as words.
std::string Words(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

Lines Describe(const Scene& scene, const SettleFacts& facts) {
  return {
      fmt::format("Left alone for {:.3g} s, the {} {}.", facts.seconds, scene.object().name,
                  facts.at_rest ? "stays at rest" : "does not stay at rest"),
      fmt::format("moved\t{:.4f} mm", facts.moved_mm),
      fmt::format("turned\t{:.4f} deg", facts.rotated_deg),
      fmt::format("not converged\t{} steps, {:.3g} mm", facts.not_converged, facts.unresolved_mm)};
}

Lines Describe(const Scene& /*scene*/, const VerdictFacts& facts) { return {facts.sentence}; }

Lines Describe(const Scene& /*scene*/, const MeshFacts& facts) {
  return {fmt::format("The object's surface in {} triangles. A contact state puts the thumb "
                      "somewhere on one of them and the index finger on another, or the same.",
                      facts.triangles),
          fmt::format("contact states\t{}", facts.nodes)};
}

Lines Describe(const Scene& /*scene*/, const ScoreFacts& facts) {
  return {fmt::format("How near is each contact state to a grasp? Its learned score, mean of {} "
                      "placements of thumb, index finger and both; a triangle has the colour of "
                      "the best state that uses it.",
                      facts.samples),
          fmt::format("best here\t{:.3f}, {}", facts.best_here.s_c, NodeText(facts.best_here)),
          fmt::format("best alone\t{:.3f}, {}", facts.best_alone.s_n, NodeText(facts.best_alone))};
}

Lines Describe(const Scene& /*scene*/, const PruneFacts& facts) {
  Lines lines;
  if (facts.cut == "context") {
    lines = {
        fmt::format("The {:g} % with the best score among the surroundings stay: with one of "
                    "these a path may begin.",
                    facts.top_percent),
        fmt::format("threshold\t{:.3f}, {} states have it", facts.threshold_c, facts.num_tied_c)};
  } else if (facts.cut == "free") {
    lines = {
        fmt::format("So do the {:g} % with the best score without surroundings: they may come "
                    "later, when the object has moved.",
                    facts.top_percent),
        fmt::format("threshold\t{:.3f}, {} states have it", facts.threshold_n, facts.num_tied_n)};
  } else {
    lines = {
        "States that share a triangle are connected: one finger stays while the other "
        "changes its place.",
        fmt::format("edges\t{}", facts.num_edges)};
  }
  if (facts.nodes_done > 0) {
    lines.push_back(fmt::format("so far\t{} nodes of this step", facts.nodes_done));
  }
  lines.push_back(fmt::format("may begin\t{}", facts.initial.size()));
  lines.push_back(fmt::format("kept\t{}", facts.kept.size()));
  return lines;
}

Lines Describe(const Scene& /*scene*/, const PathFacts& facts) {
  const bool paper = facts.order == "paper", by_hand = facts.order == "hand";
  Lines lines = {
      by_hand ? fmt::format("A path of {} contact states that a script put together.",
                            facts.nodes.size())
      : paper
          ? fmt::format("Path {}: of all paths of {} contact states the one with rank {} by the "
                        "sum of its scores.",
                        facts.rank, facts.nodes.size(), facts.rank)
          : fmt::format("Path {}: of all first states that a fingertip can touch and that no "
                        "path has tried, the best by its score over 1 + {:g}, for what the paths "
                        "before it have in common with it.",
                        facts.rank, facts.repeats),
      fmt::format("score\t{:.3f}", facts.score)};
  if (facts.num_tied > 1) {
    lines[0] += fmt::format(
        " {}{} paths have exactly this {}; {}.", facts.num_tied,
        facts.num_tied == kMostTied ? " or more" : "", paper ? "score" : "value",
        facts.tie_rule == "scores" ? "the ranks of their states decide among them"
                                   : "the order of some is that of their states' numbers");
  }
  constexpr double kLeast = PathExplorer::kLeastScore;
  if (!paper && !by_hand && facts.value * (1.0 + facts.repeats) <= kLeast * (1.0 + 1e-12)) {
    lines[0] += fmt::format(" Scores below {:g} % of the best count as that.", 100.0 * kLeast);
  }
  for (std::size_t i = 0; i < facts.nodes.size(); ++i) {
    lines.push_back(fmt::format("stage {}\t{:.3f}, thumb {}, index {}", i + 1, facts.terms[i],
                                facts.nodes[i].thumb, facts.nodes[i].index));
  }
  if (!facts.siblings.empty()) {
    lines.push_back(fmt::format("next best, other end\t{:.3f} behind",
                                facts.score - facts.siblings.front().score));
  }
  return lines;
}

Lines Describe(const Scene& /*scene*/, const ScreenFacts& facts) {
  return {
      fmt::format("Round {} of screening: {} plans along path {} were simulated, to see whether "
                  "it is worth more. The object is where the best of them leaves it.",
                  facts.round, facts.rollouts, facts.path),
      fmt::format("worth\t{:.3f}", facts.value),
      fmt::format("doing nothing\t{:.3f}", facts.rest_reward),
      fmt::format("score, end\t{:.3f}", facts.best.final_score),
      fmt::format("room for grasps\t{:.3f}", facts.best.room)};
}

std::string EndOfOptimisation(const IterationFacts& facts) {
  if (facts.end.empty()) return "";
  return facts.end == "limit" ? fmt::format(" The limit of {} iterations ends it.", facts.limit)
                              : " It ends, as the best cost hardly falls any more.";
}

Lines Describe(const Scene& /*scene*/, const IterationFacts& facts) {
  Lines lines = {
      fmt::format("Iteration {}: {} plans were simulated, noise about the mean or steady pushes. "
                  "The object is where the best plan so far leaves it, the outlines are where the "
                  "best of this iteration do; the mean moves to their average, in which the best "
                  "weigh most.{}",
                  facts.iteration, facts.rollouts.size(), EndOfOptimisation(facts)),
      fmt::format("best cost\t{:.3f}", facts.best_cost),
      fmt::format("mean cost\t{:.3f}", facts.mean_cost)};
  for (std::size_t i = 0; i < facts.best.stage_scores.size(); ++i) {
    lines.push_back(fmt::format("score, stage {}\t{:.3f}", i + 1, facts.best.stage_scores[i]));
  }
  lines.push_back(fmt::format("score, end\t{:.3f}", facts.best.final_score));
  lines.push_back(fmt::format("room for grasps\t{:.3f}", facts.best.room));
  for (const CostTermFacts& term : facts.best.terms) {
    if (term.value >= 5e-4) {
      lines.push_back(fmt::format("cost of {}\t{:.3f}", Words(term.name), term.value));
    }
  }
  return lines;
}

// What moves the object in a stage: "index on triangle 31".
std::string DescribeStage(const StageFacts& stage) {
  std::string text;
  for (const StageFingerFacts& finger : stage) {
    if (!finger.on) continue;
    text += fmt::format("{}{} ", text.empty() ? "" : ", ", FingerName(finger.finger));
    text += finger.kept ? "stays" : fmt::format("on triangle {}", finger.triangle);
  }
  return text.empty() ? "no finger" : text;
}

Lines Describe(const Scene& scene, const CertifyFacts& facts) {
  Lines lines;
  if (facts.certified) {
    lines.push_back(fmt::format(
        "{}, simulated again by Simbody and at half the time step, leaves the {} where it stays. "
        "Without the fingers it {}, so they {}.",
        facts.plan == 0   ? "The plan made by hand"
        : facts.plan == 1 ? "The best plan"
                          : fmt::format("Plan {} of those kept", facts.plan),
        scene.object().name, facts.stays_when_released ? "stays too" : "would move",
        facts.stays_when_released ? "may leave" : "must keep pressing"));
  } else {
    lines.push_back("Not certified: " + Join(facts.reasons, "; ") + ".");
    if (facts.out_of_reach_t) {
      lines.push_back(fmt::format("out of reach at\t{:.2f} s", *facts.out_of_reach_t));
    }
  }
  for (std::size_t i = 0; i < facts.stages.size(); ++i) {
    lines.push_back(fmt::format("stage {}\t{}", i + 1, DescribeStage(facts.stages[i])));
  }
  lines.push_back(fmt::format("moves in {:g} s\t{:.2f} mm, {:.2f} deg", facts.hold_seconds,
                              facts.hold_shift_mm, facts.hold_turn_deg));
  lines.push_back(fmt::format("at half the step\t{:.2f} mm, {:.2f} deg elsewhere",
                              facts.step_shift_mm, facts.step_turn_deg));
  lines.push_back(fmt::format("moves if released\t{:.1f} mm, {:.1f} deg", facts.released_shift_mm,
                              facts.released_turn_deg));
  lines.push_back(fmt::format("largest force\t{:.2f} N", facts.max_force_N));
  if (facts.not_converged > 0) {
    lines.push_back(fmt::format("not converged\t{} steps, {:.3g} mm", facts.not_converged,
                                facts.unresolved_mm));
  }
  if (facts.robust) {
    lines.push_back(fmt::format("in changed worlds\t{} of {} end alike", facts.robust->held,
                                facts.robust->worlds));
    if (!facts.robust->elsewhere.empty()) {
      std::vector<std::string> changes;
      for (const std::string& change : facts.robust->elsewhere) changes.push_back(Words(change));
      lines.push_back("not with\t" + Join(changes, ", "));
    }
  }
  return lines;
}

Lines Describe(const Scene& /*scene*/, const GraspFacts& facts) {
  Lines lines = {facts.sentence};
  if (facts.moved_mm > 0.0) {
    lines.push_back(fmt::format("contacts moved by\t{:.1f} mm", facts.moved_mm));
  }
  for (const GraspContactFacts& contact : facts.contacts) {
    if (!facts.feasible) break;
    lines.push_back(fmt::format("{}\t{:.2f} N", FingerName(contact.finger), contact.f_O.norm()));
  }
  if (facts.clearance_mm) {
    lines.push_back(fmt::format("hand clearance\t{:.1f} mm", *facts.clearance_mm));
  }
  return lines;
}

Lines Describe(const Scene& /*scene*/, const LiftFacts& facts) {
  Lines lines = {facts.sentence};
  lines.push_back(fmt::format("came\t{:.1f} mm", 1e3 * facts.height_m));
  lines.push_back(
      fmt::format("off its way\t{:.1f} mm, {:.1f} deg at most", facts.shift_mm, facts.turn_deg));
  lines.push_back(fmt::format("fingertips slid\t{:.1f} mm", facts.slip_mm));
  if (facts.not_converged > 0) {
    lines.push_back(fmt::format("not converged\t{} steps, {:.3g} mm", facts.not_converged,
                                facts.unresolved_mm));
  }
  if (facts.held) {
    lines.push_back(fmt::format("pushes withstood\t{} of 6", facts.pushes));
    lines.push_back(fmt::format("softer, stiffer hand\t{}, {}",
                                facts.soft ? "holds" : "does not hold",
                                facts.stiff ? "holds" : "does not hold"));
  }
  return lines;
}

Lines Describe(const Scene& /*scene*/, const FrameFacts& facts) {
  std::vector<std::string> touching;
  for (const PlaceFacts& place : facts.touching) touching.emplace_back(FingerName(place.finger));
  std::string verdict = "The collision check finds the hand free.";
  if (facts.failed) verdict = "No hand pose was found; this is the best attempt.";
  if (!facts.way_clear) verdict = "The way from the frame before goes through something.";
  if (!facts.failed && facts.loosened != "none") {
    verdict = fmt::format("Only with a demand loosened: {}.", facts.loosened);
  }
  return {
      fmt::format("{}: {}. {}", facts.phase,
                  touching.empty() ? "no finger touches" : Join(touching, ", ") + " on the object",
                  verdict),
      fmt::format("clearance\t{:.2f} mm", facts.clearance_mm),
      fmt::format("tip error\t{:.2f} mm", facts.tip_error_mm)};
}

Lines Describe(const Scene& /*scene*/, const MotionFacts& facts) {
  return {fmt::format("The hand's motion in {} frames, keyframes solved in {} order.", facts.frames,
                      facts.order),
          fmt::format("failed frames\t{}", facts.failed),
          fmt::format("blocked ways\t{}", facts.blocked_ways),
          fmt::format("loosened frames\t{}", facts.loosened),
          fmt::format("least clearance\t{:.2f} mm", facts.min_clearance_mm),
          fmt::format("largest tip error\t{:.2f} mm", facts.max_tip_error_mm),
          fmt::format("fastest joint\t{:.2f} rad/s", facts.rates.joint_speed),
          fmt::format("fastest wrist\t{:.2f} m/s", facts.rates.wrist_speed),
          fmt::format("frames over a limit\t{}", facts.over_limits)};
}

Lines Describe(const Scene& scene, const OpenFacts& /*facts*/) {
  return internal::DescribeScene(scene);
}

Lines Describe(const Scene& /*scene*/, const SimulationFacts& /*facts*/) { return {}; }

}  // namespace

std::vector<std::string> internal::DescribePlanning(const Scene& scene, const StepFacts& step) {
  return std::visit([&](const auto& facts) { return Describe(scene, facts); }, step.details);
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
  if (!node.thumb_fits && !node.index_fits) {
    text +=
        "; no fingertip can be on either of its triangles at the start, so that no path begins "
        "with it in the order that explores";
  }
  if (node.occluded > 0.0) {
    text += fmt::format("; no fingertip can be at {:.0f} % of its contacts", 100 * node.occluded);
  }
  return text;
}

}  // namespace pregrasp
