#include "app/pictures/reasons.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "app/core/check.h"
#include "app/core/error.h"
#include "app/core/text.h"
#include "app/dynamics/tip_overlap.h"
#include "app/pictures/words.h"

namespace pregrasp {
namespace {

using Item = Explanation::Item;

std::string PathText(const PathFacts& path) {
  std::string nodes;
  for (const NodeFacts& node : path.nodes) {
    nodes += fmt::format("{}{}", nodes.empty() ? "" : " > ", node.id);
  }
  return path.rank == 0 ? fmt::format("the path {}", nodes)
                        : fmt::format("path {} ({})", path.rank, nodes);
}

std::string Capital(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

// A cost's parts, as they add up to its total: rewards count against it.
std::vector<std::pair<std::string, double>> PartsOf(const CostFacts& cost) {
  std::vector<std::pair<std::string, double>> parts = {{"reward", -cost.reward}};
  for (const CostTermFacts& term : cost.terms) parts.emplace_back(term.name, term.value);
  return parts;
}

std::string WithBlanks(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

// Of a rollout, from 1.
const CostFacts& CostOf(const IterationFacts& iteration, int rollout) {
  const auto count = std::ssize(iteration.rollouts);
  if (rollout < 1 || rollout > count) {
    throw InputError("", "rollout", fmt::format("a rollout from 1 to {}", count),
                     std::to_string(rollout));
  }
  return iteration.rollouts[static_cast<std::size_t>(rollout) - 1].cost;
}

// How many rollouts are cheaper, plus 1; of equal ones the first comes first.
int RankOf(const IterationFacts& iteration, int rollout) {
  const double total = CostOf(iteration, rollout).total;
  int rank = 1;
  for (int i = 1; i <= std::ssize(iteration.rollouts); ++i) {
    const double other = CostOf(iteration, i).total;
    rank += other < total || (other == total && i < rollout) ? 1 : 0;
  }
  return rank;
}

// The parts of `cost` beside those of `other`, which has the same, the one that differs most first.
std::vector<Item> CompareParts(const CostFacts& cost,
                               const std::vector<std::pair<std::string, double>>& other) {
  std::vector<Item> items;
  const auto parts = PartsOf(cost);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    items.push_back({parts[i].first, parts[i].second, other[i].second, {}});
  }
  std::stable_sort(items.begin(), items.end(), [](const Item& a, const Item& b) {
    return std::abs(*a.value - *a.other) > std::abs(*b.value - *b.other);
  });
  return items;
}

// "reward by 0.210, tip overlap by 0.100": of the items those that count at least a tenth of the
// first, on the side that `sign` says.
std::string NameLargest(const std::vector<Item>& items, double sign) {
  std::string text;
  double largest = 0.0;
  int named = 0;
  for (const Item& item : items) {
    const double gain = sign * (*item.value - *item.other);
    if (gain < 5e-4 || gain < 0.1 * largest || named == 3) continue;
    largest = std::max(largest, gain);
    text += fmt::format("{}{} by {:.3f}", named++ == 0 ? "" : ", ", WithBlanks(item.name), gain);
  }
  return text;
}

std::string Counted(int count, int total) { return fmt::format("{} of {}", count, total); }

}  // namespace

Explanation ExplainPath(const PathFacts& path) {
  Explanation why;
  why.verdict = path.order;
  why.items.push_back({"value", path.value, {}, {}});
  if (path.order == "explore") why.items.push_back({"repeats", path.repeats, {}, {}});
  for (std::size_t i = 0; i < path.terms.size(); ++i) {
    why.items.push_back({fmt::format("stage_{}", i + 1), path.terms[i], {}, {}});
  }
  std::string terms;
  for (const double term : path.terms) {
    terms += fmt::format("{}{:.3f}", terms.empty() ? "" : " + ", term);
  }
  if (path.order == "hand") {
    why.text = fmt::format("{} was put together by a script; the states score {} = {:.3f}",
                           Capital(PathText(path)), terms, path.score);
    return why;
  }
  why.text = fmt::format("{} of {:.0f}: its states score {} = {:.3f}", Capital(PathText(path)),
                         path.num_paths, terms, path.score);
  if (path.order == "explore") {
    why.text += fmt::format(
        "; in the order that explores its first state counts, as a share of the best such score "
        "and over 1 + {:g} for what paths before it had of it: {:.3f}, the most that was left",
        path.repeats, path.value);
  } else {
    why.text += ", and no path that is left has a higher sum";
  }
  if (path.num_tied > 1) {
    why.text += fmt::format("; {} paths have exactly that, among which {}", path.num_tied,
                            path.tie_rule == "scores" ? "the ranks of their states decide"
                                                      : "some have but their numbers to differ by");
  }
  for (const PathFacts::Sibling& sibling : path.siblings) {
    std::string nodes;
    for (const int id : sibling.nodes) {
      nodes += fmt::format("{}{}", nodes.empty() ? "" : " > ", id);
    }
    why.items.push_back({"beat " + nodes, sibling.score, path.score, {}});
  }
  if (!path.siblings.empty()) {
    why.text += fmt::format("; of those that begin alike the next is {:.3f} behind",
                            path.score - path.siblings.front().score);
  }
  return why;
}

Explanation ExplainOrder(const PathFacts& path, const PathFacts& other) {
  Explanation why;
  why.verdict = path.rank > other.rank ? "behind" : path.rank < other.rank ? "before" : "same";
  why.items = {{"value", path.value, other.value, {}},
               {"score", path.score, other.score, {}},
               {"repeats", path.repeats, other.repeats, {}}};
  for (std::size_t i = 0; i < std::max(path.terms.size(), other.terms.size()); ++i) {
    Item item{fmt::format("stage_{}", i + 1), {}, {}, {}};
    if (i < path.terms.size()) item.value = path.terms[i];
    if (i < other.terms.size()) item.other = other.terms[i];
    why.items.push_back(item);
  }
  if (why.verdict == "same") {
    why.text = Capital(PathText(path)) + " is that path";
    return why;
  }
  why.text = fmt::format("{} comes {} {}", Capital(PathText(path)),
                         why.verdict == "behind" ? "after" : "before", PathText(other));
  if (path.value != other.value) {
    why.text += fmt::format(": {:.3f} against {:.3f}", path.value, other.value);
    if (path.repeats != other.repeats) {
      why.text += fmt::format(
          ", as paths before it had {:g} of what it has, and {:g} of the other; the scores are "
          "{:.3f} and {:.3f}",
          path.repeats, other.repeats, path.score, other.score);
    }
  } else {
    why.text += fmt::format(": both are worth {:.3f}, and {}", path.value,
                            path.tie_rule == "number" || other.tie_rule == "number"
                                ? "of some that are alike the lower number goes first"
                                : "the ranks of their states decide");
  }
  return why;
}

int FindBestRollout(const IterationFacts& iteration) {
  PREGRASP_CHECK(!iteration.rollouts.empty());
  const auto best = std::min_element(
      iteration.rollouts.begin(), iteration.rollouts.end(),
      [](const RolloutFacts& a, const RolloutFacts& b) { return a.cost.total < b.cost.total; });
  return static_cast<int>(best - iteration.rollouts.begin()) + 1;
}

Explanation ExplainRollout(const IterationFacts& iteration, int rollout) {
  const CostFacts& cost = CostOf(iteration, rollout);
  const auto count = static_cast<double>(iteration.rollouts.size());
  std::vector<std::pair<std::string, double>> mean;
  for (const RolloutFacts& one : iteration.rollouts) {
    const auto parts = PartsOf(one.cost);
    mean.resize(parts.size());
    for (std::size_t i = 0; i < parts.size(); ++i) {
      mean[i].first = parts[i].first;
      mean[i].second += parts[i].second / count;
    }
  }
  Explanation why;
  const int rank = RankOf(iteration, rollout);
  why.verdict = rank == 1 ? "best" : cost.total <= iteration.mean_cost ? "cheap" : "dear";
  why.items = CompareParts(cost, mean);
  why.items.insert(why.items.begin(), {"total", cost.total, iteration.mean_cost, {}});
  why.text = fmt::format(
      "Rollout {} is number {} of {} by cost: {:.3f}, the mean being {:.3f}. Its reward is {:.3f}: "
      "{:.3f} for how near the end is to a grasp, {:.3f} for room there, the rest for its stages' "
      "starts.",
      rollout, rank, iteration.rollouts.size(), cost.total, iteration.mean_cost, cost.reward,
      cost.final_score, cost.room);
  const std::vector<Item> parts(why.items.begin() + 1, why.items.end());
  const std::string cheaper = NameLargest(parts, -1.0), dearer = NameLargest(parts, 1.0);
  if (!cheaper.empty()) why.text += " Cheaper than the mean: " + cheaper + ".";
  if (!dearer.empty()) why.text += " Dearer: " + dearer + ".";
  return why;
}

Explanation ExplainRolloutAgainst(const IterationFacts& iteration, int rollout, int other) {
  const CostFacts &cost = CostOf(iteration, rollout), &against = CostOf(iteration, other);
  Explanation why;
  const double behind = cost.total - against.total;
  why.verdict = behind > 0.0 ? "dearer" : behind < 0.0 ? "cheaper" : "same";
  why.items = CompareParts(cost, PartsOf(against));
  why.text = fmt::format("Rollout {} costs {:.3f}, rollout {} {:.3f}", rollout, cost.total, other,
                         against.total);
  const std::string dearer = NameLargest(why.items, 1.0), cheaper = NameLargest(why.items, -1.0);
  if (!dearer.empty()) why.text += "; dearer: " + dearer;
  if (!cheaper.empty()) why.text += "; cheaper: " + cheaper;
  why.items.insert(why.items.begin(), {"total", cost.total, against.total, {}});
  return why;
}

Explanation ExplainCertificate(const Scene& scene, const CertifyFacts& facts,
                               const CertifyConfig& config) {
  Explanation why;
  why.verdict = facts.certified ? "certified" : "not_certified";
  const auto add = [&](const char* name, double value, double limit, const char* unit) {
    why.items.push_back({name, value, {}, limit, unit, value <= limit});
  };
  add("hold_shift", facts.hold_shift_mm, 1e3 * config.max_hold_shift, "mm");
  add("hold_turn", facts.hold_turn_deg, config.max_hold_turn_deg, "deg");
  add("tip_overlap", facts.max_tip_overlap_mm, 1e3 * kTipOverlapAllowed, "mm");
  add("unresolved", facts.unresolved_mm, 1e3 * config.max_unresolved, "mm");
  why.items.push_back({"step_shift", facts.step_shift_mm, {}, {}, "mm"});
  why.items.push_back({"step_turn", facts.step_turn_deg, {}, {}, "deg"});
  why.items.push_back({"released_shift", facts.released_shift_mm, {}, {}, "mm"});
  why.items.push_back({"released_turn", facts.released_turn_deg, {}, {}, "deg"});
  if (facts.out_of_reach_t) {
    why.items.push_back({"out_of_reach_at", *facts.out_of_reach_t, {}, {}, "s"});
  }
  if (facts.certified) {
    why.text = fmt::format(
        "Certified: in the hold of {:g} s the {} moves {:.2f} mm (at most {:g}) and turns {:.2f} "
        "deg (at most {:g}), and at half the time step the verdict is the same, {:.2f} mm "
        "elsewhere; without the fingers it {}",
        facts.hold_seconds, scene.object().name, facts.hold_shift_mm, 1e3 * config.max_hold_shift,
        facts.hold_turn_deg, config.max_hold_turn_deg, facts.step_shift_mm,
        facts.stays_when_released
            ? "stays too"
            : fmt::format("would move {:.1f} mm and turn {:.1f} deg, so they keep pressing",
                          facts.released_shift_mm, facts.released_turn_deg));
    return why;
  }
  why.text = "Not certified: ";
  for (std::size_t i = 0; i < facts.reasons.size(); ++i) {
    why.text += (i == 0 ? "" : "; ") + facts.reasons[i];
  }
  for (const Item& item : why.items) {
    if (item.met.value_or(true)) continue;
    why.text += fmt::format("; {} is {:.2f} {}, at most {:g} is allowed", WithBlanks(item.name),
                            *item.value, item.unit, *item.limit);
  }
  if (facts.out_of_reach_t) {
    why.text += fmt::format("; the hand has no pose at {:.2f} s", *facts.out_of_reach_t);
  }
  return why;
}

Explanation ExplainGrasp(const GraspFacts& grasp, const LiftFacts* lift) {
  Explanation why;
  why.verdict = grasp.status;
  why.text = fmt::format("Grasp {} of the {}: {}", grasp.number, grasp.source, grasp.sentence);
  if (grasp.margin) why.items.push_back({"margin", *grasp.margin, {}, {}});
  if (grasp.min_normal_N) {
    why.items.push_back({"min_normal", *grasp.min_normal_N, {}, {}, "N"});
  }
  if (grasp.tip_error_mm) why.items.push_back({"tip_error", *grasp.tip_error_mm, {}, {}, "mm"});
  if (grasp.clearance_mm) why.items.push_back({"clearance", *grasp.clearance_mm, {}, {}, "mm"});
  if (grasp.moved_mm > 0.0) why.items.push_back({"moved", grasp.moved_mm, {}, {}, "mm"});
  if (lift != nullptr) {
    why.verdict = lift->held ? "lifted" : "not_lifted";
    why.text += ". Its lift: " + lift->sentence;
    why.items.push_back({"lift_height", 1e3 * lift->height_m, {}, {}, "mm"});
    why.items.push_back({"lift_shift", lift->shift_mm, {}, {}, "mm"});
    why.items.push_back({"lift_turn", lift->turn_deg, {}, {}, "deg"});
    why.items.push_back({"lift_slip", lift->slip_mm, {}, {}, "mm"});
  }
  return why;
}

Explanation ExplainGrasps(const std::vector<GraspWithLift>& grasps) {
  std::map<std::string, int> failed, unlifted;
  std::map<std::string, const GraspFacts*> example;
  std::map<std::string, std::map<std::string, int>> pairs;
  int feasible = 0, held = 0;
  for (const auto& [grasp, lift] : grasps) {
    if (grasp->feasible) {
      ++feasible;
      held += lift != nullptr && lift->held ? 1 : 0;
      if (lift != nullptr && !lift->held) {
        for (const std::string& reason : lift->reasons) ++unlifted[reason];
      }
      continue;
    }
    ++failed[grasp->status];
    example.emplace(grasp->status, grasp);
    std::string pair;
    for (const std::string& name : grasp->colliding) pair += (pair.empty() ? "" : " and ") + name;
    if (!pair.empty()) ++pairs[grasp->status][pair];
  }
  const auto total = static_cast<int>(grasps.size());
  Explanation why;
  why.verdict = grasps.empty()  ? "none"
                : feasible == 0 ? "none_feasible"
                : held == 0     ? "none_lifts"
                                : "lifts";
  why.items = {{"feasible", static_cast<double>(feasible), static_cast<double>(total), {}},
               {"lifting", static_cast<double>(held), static_cast<double>(feasible), {}}};
  if (grasps.empty()) {
    why.text = "There are no grasps: no place that was tried is free for a fingertip";
    return why;
  }
  why.text = feasible == 0 ? fmt::format("None of {} grasps is feasible", total)
                           : fmt::format("{} grasps are feasible, {} of these are lifted",
                                         Counted(feasible, total), held);
  std::vector<std::pair<std::string, int>> order(failed.begin(), failed.end());
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  for (const auto& [status, count] : order) {
    why.items.push_back({status, static_cast<double>(count), static_cast<double>(total), {}});
    why.text += fmt::format("{}{} {}", status == order.front().first ? ". " : "; ", count,
                            WithBlanks(status));
    const auto& named = pairs[status];
    const auto most =
        std::max_element(named.begin(), named.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    if (most != named.end()) {
      why.text += fmt::format(" (most often {})", most->first);
    } else {
      why.text +=
          fmt::format(" (number {}: {})", example.at(status)->entry, example.at(status)->sentence);
    }
  }
  for (const auto& [reason, count] : unlifted) {
    why.items.push_back(
        {"lift_" + reason, static_cast<double>(count), static_cast<double>(feasible), {}});
  }
  if (held == 0 && feasible > 0) {
    why.text += ". Lifts fail as: ";
    std::string reasons;
    for (const auto& [reason, count] : unlifted) {
      reasons += fmt::format("{}{} ({})", reasons.empty() ? "" : ", ", WithBlanks(reason), count);
    }
    why.text += reasons;
  }
  return why;
}

Explanation ExplainFrame(const FrameFacts& frame, const MotionConfig& config) {
  Explanation why;
  why.verdict = frame.failed ? "failed" : frame.loosened;
  const double most = 1e3 * config.ik.tip_tolerance;
  why.items = {{"tip_error", frame.tip_error_mm, {}, most, "mm", frame.tip_error_mm <= most},
               {"clearance", frame.clearance_mm, {}, {}, "mm"}};
  const std::string what = frame.keyframe > 0 ? fmt::format("Keyframe {}", frame.keyframe)
                                              : fmt::format("Frame {}", frame.frame);
  const std::string numbers = fmt::format(
      "its worst tip misses by {:.2f} mm (at most {:g}), with {:.2f} mm to the nearest body",
      frame.tip_error_mm, most, frame.clearance_mm);
  if (!frame.way_clear) {
    why.text =
        fmt::format("{} ({}) fails: the way from the frame before goes through something; {}", what,
                    frame.phase, numbers);
  } else if (frame.failed) {
    why.text = fmt::format(
        "{} ({}) fails: no hand pose keeps what is demanded, nor with all that may be loosened; {}",
        what, frame.phase, numbers);
  } else if (frame.loosened == "none") {
    why.text = fmt::format("{} ({}) keeps all that is demanded: {}", what, frame.phase, numbers);
  } else {
    why.text = fmt::format(
        "{} ({}) has no pose that keeps all that is demanded; with {} loosened it has one: {}",
        what, frame.phase, WithBlanks(frame.loosened), numbers);
  }
  return why;
}

Explanation ExplainMotionEnd(const MotionFacts& facts) {
  Explanation why;
  why.verdict = facts.failed == 0 ? "clean" : "failed";
  why.items = {
      {"failed", static_cast<double>(facts.failed), static_cast<double>(facts.frames), {}},
      {"blocked_ways",
       static_cast<double>(facts.blocked_ways),
       static_cast<double>(facts.frames),
       {}},
      {"loosened", static_cast<double>(facts.loosened), static_cast<double>(facts.frames), {}},
      {"over_limits",
       static_cast<double>(facts.over_limits),
       static_cast<double>(facts.frames),
       {}},
      {"max_tip_error", facts.max_tip_error_mm, {}, {}, "mm"},
      {"min_clearance", facts.min_clearance_mm, {}, {}, "mm"}};
  why.text = fmt::format(
      "Of {} frames {} fail, {} of them for the way to them; {} gave something up, {} are over a "
      "limit of "
      "the hand's speed or acceleration",
      facts.frames, facts.failed, facts.blocked_ways, facts.loosened, facts.over_limits);
  return why;
}

namespace {

// The rows of what a picture says of a step, by their labels.
std::vector<std::pair<std::string, std::string>> RowsOf(const Scene& scene, const StepFacts& step,
                                                        const FactsSource& steps) {
  std::vector<std::pair<std::string, std::string>> rows;
  for (const std::string& line : DescribeStep(scene, step, steps)) {
    const std::size_t tab = line.find('\t');
    if (tab != std::string::npos) rows.emplace_back(line.substr(0, tab), line.substr(tab + 1));
  }
  return rows;
}

// "the object: place, x [m]: -0.1155 and -0.12".
std::string ShowDifference(const FactsDifference& difference) {
  return fmt::format("{}: {} and {}", DescribeField(difference.field),
                     OneLine(DescribeValue(difference.left, difference.right)),
                     OneLine(DescribeValue(difference.right, difference.left)));
}

}  // namespace

Explanation ExplainDifference(const BranchComparison& comparison, const Scene& left_scene,
                              const Scene& right_scene, const StepFacts& left,
                              const StepFacts& right, const FactsSource& left_steps,
                              const FactsSource& right_steps) {
  Explanation why;
  if (comparison.same()) {
    why.verdict = "same";
    why.text =
        fmt::format("{} and {} say the same, and so does all that led to them", left.id, right.id);
    return why;
  }
  why.verdict = "differ";
  if (comparison.scene) {
    why.text = fmt::format("The scenes differ in {}. ", ShowDifference(*comparison.scene));
  }
  why.text += comparison.common == nullptr
                  ? "They differ from the start"
                  : fmt::format("They are the same up to {}", comparison.common->id());
  if (comparison.left == nullptr && comparison.right == nullptr) {
    why.text += ", the last step of both";
  } else if (comparison.left == nullptr || comparison.right == nullptr) {
    const Timeline::Node* further = comparison.left == nullptr ? comparison.right : comparison.left;
    why.verdict = "one_goes_on";
    why.text += fmt::format(", where one ends and the other goes on with {}", further->id());
  } else {
    why.text += fmt::format(". Then come {} and {}", comparison.left->id(), comparison.right->id());
    if (comparison.command) {
      why.text += fmt::format(", with {} {} and {}", comparison.command->field,
                              comparison.command->left, comparison.command->right);
    }
    if (comparison.same_noise) {
      why.text +=
          *comparison.same_noise ? ", on the same draws of noise" : ", on other draws of noise";
    }
    if (comparison.facts) {
      why.text +=
          fmt::format("; what first differs of them is {}", ShowDifference(*comparison.facts));
    } else if (comparison.left->command.verb == comparison.right->command.verb) {
      why.text += "; what came of them is the same";
    }
  }
  const auto rows = RowsOf(left_scene, left, left_steps),
             others = RowsOf(right_scene, right, right_steps);
  std::string ends;
  for (const auto& [label, value] : rows) {
    const auto found =
        std::find_if(others.begin(), others.end(),
                     [&, name = label](const auto& row) { return row.first == name; });
    if (found == others.end() || found->second == value) continue;
    ends += fmt::format("{}{} {} and {}", ends.empty() ? "" : "; ", label, value, found->second);
  }
  if (!ends.empty()) why.text += fmt::format(". At {} and {}: {}", left.id, right.id, ends);
  return why;
}

}  // namespace pregrasp
