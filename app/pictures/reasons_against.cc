// Why something is not another: the numbers of both beside each other.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "app/core/error.h"
#include "app/job/run_summary.h"
#include "app/pictures/reasons.h"

namespace pregrasp {
namespace {

using Reached = Progress::Reached;
using ReasonItem = Explanation::Item;

std::string Spaced(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

// What explains one thing beside what explains another of its kind, number by number.
std::vector<ReasonItem> PairItems(const Explanation& one, const Explanation& other) {
  std::vector<ReasonItem> items = one.items;
  for (const ReasonItem& item : other.items) {
    const auto found = std::find_if(items.begin(), items.end(),
                                    [&](const ReasonItem& own) { return own.name == item.name; });
    if (found != items.end()) {
      found->other = item.value;
    } else {
      items.push_back({item.name, {}, item.value, item.limit, item.unit});
    }
  }
  return items;
}

std::string ShowItem(const ReasonItem& item) {
  const auto number = [&](const std::optional<double>& value) {
    return value ? fmt::format("{:.4g}", *value + 0.0) : std::string("none");
  };
  std::string text = fmt::format("{} {} against {}{}{}", Spaced(item.name), number(item.value),
                                 number(item.other), item.unit.empty() ? "" : " ", item.unit);
  if (item.limit) text += fmt::format(", at most {:g} is allowed", *item.limit);
  return text;
}

// The numbers that differ, those first of which one keeps its limit and the other does not; then by
// how much, as a share of the larger.
std::string ShowDifferences(const std::vector<ReasonItem>& items) {
  constexpr std::size_t kMost = 3;
  constexpr double kAlike = 0.01;
  std::vector<std::pair<double, const ReasonItem*>> order;
  for (const ReasonItem& item : items) {
    if (!item.value || !item.other) continue;
    const double apart = std::abs(*item.value - *item.other);
    const double size = std::max({std::abs(*item.value), std::abs(*item.other), 1e-9});
    if (apart <= kAlike * size || apart < 5e-4) continue;
    const bool decides = item.limit && (*item.value <= *item.limit) != (*item.other <= *item.limit);
    order.emplace_back(decides ? 2.0 : apart / (2.0 * size), &item);
  }
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::string text;
  for (std::size_t i = 0; i < std::min(order.size(), kMost); ++i) {
    text += (i == 0 ? "" : "; ") + ShowItem(*order[i].second);
  }
  return text;
}

// "worse", "better" or "alike".
template <typename Key>
std::string Standing(const Key& own, const Key& other) {
  return own < other ? "worse" : other < own ? "better" : "alike";
}

void AddDifferences(Explanation& why) {
  const std::string differences = ShowDifferences(why.items);
  if (!differences.empty()) why.text += ": " + differences;
}

std::string JoinReasons(const std::vector<std::string>& reasons) {
  std::string text;
  for (const std::string& reason : reasons) text += (text.empty() ? "" : ", ") + Spaced(reason);
  return text;
}

// What a choice among grasps goes by, in turn.
struct GraspCriterion {
  const char* name;
  double own, other;
  const char* better;  // what is so of the better one
  const char* worse;
};

std::vector<GraspCriterion> CompareLifts(const GraspFacts& grasp, const LiftFacts& lift,
                                         const GraspFacts& other_grasp, const LiftFacts& other) {
  const auto flag = [](bool is) { return is ? 1.0 : 0.0; };
  const auto stiffnesses = [&](const LiftFacts& of) { return flag(of.soft) + flag(of.stiff); };
  const auto generated = [&](const GraspFacts& of) { return flag(of.source == "generator"); };
  return {
      {"lift_held", flag(lift.held), flag(other.held), "its lift is held", "its lift is not held"},
      {"neighbours_in_place", flag(!lift.neighbours.disturbed), flag(!other.neighbours.disturbed),
       "it disturbs no neighbour", "it disturbs a neighbour"},
      {"pushes", static_cast<double>(lift.pushes), static_cast<double>(other.pushes),
       "it withstands more pushes", "it withstands fewer pushes"},
      {"soft_and_stiff", stiffnesses(lift), stiffnesses(other),
       "it lifts with more of softer and stiffer fingers",
       "it lifts with fewer of softer and stiffer fingers"},
      {"generated", generated(grasp), generated(other_grasp), "it is the generator's",
       "it is the search's"},
      {"forearm_free", flag(lift.forearm_free), flag(other.forearm_free), "its forearm is free",
       "its forearm is not free"},
      {"margin", grasp.margin.value_or(0.0), other_grasp.margin.value_or(0.0),
       "its margin is larger", "its margin is smaller"},
  };
}

// How far a path came, and by what.
struct PathProgress {
  const Timeline::Node* furthest = nullptr;  // null: no step of it is there
  const ScreenFacts* screened = nullptr;
  const IterationFacts* optimised = nullptr;
  int plans = 0, certified = 0, grasps = 0, lifts = 0;
  bool moved = false;
};

int PathOfStep(const StepFacts& facts) {
  if (const auto* path = std::get_if<PathFacts>(&facts.details)) return path->rank;
  return std::visit(
      [](const auto& details) {
        if constexpr (requires { details.path; }) return details.path;
        return -1;
      },
      facts.details);
}

PathProgress FollowPath(const Timeline& timeline, int rank) {
  PathProgress path;
  for (const auto& node : timeline.nodes()) {
    if (PathOfStep(node->facts) != rank) continue;
    if (path.furthest == nullptr || !(node->progress < path.furthest->progress)) {
      path.furthest = node.get();
    }
    if (const auto* screen = std::get_if<ScreenFacts>(&node->facts.details)) path.screened = screen;
    if (const auto* last = std::get_if<IterationFacts>(&node->facts.details)) path.optimised = last;
    if (const auto* certify = std::get_if<CertifyFacts>(&node->facts.details)) {
      ++path.plans;
      path.certified += certify->certified ? 1 : 0;
    }
    path.grasps += std::holds_alternative<GraspFacts>(node->facts.details) ? 1 : 0;
    path.lifts += std::holds_alternative<LiftFacts>(node->facts.details) ? 1 : 0;
    path.moved = path.moved || std::holds_alternative<FrameFacts>(node->facts.details);
  }
  return path;
}

std::string DescribePath(const PathProgress& path) {
  if (path.furthest == nullptr) return "was not tried";
  const Progress& progress = path.furthest->progress;
  switch (progress.reached) {
    case Reached::kNothing:
      if (path.optimised != nullptr) return "was optimised, and no plan of it was certified yet";
      if (path.screened == nullptr) return "was chosen, and nothing was done with it";
      return fmt::format(
          "was screened, where its best plan was worth {:.3f} and doing nothing {:.3f}, and was "
          "not "
          "optimised",
          path.screened->value, path.screened->rest_reward);
    case Reached::kTrajectory:
      return fmt::format("came to {} plan{}, of which none is certified", path.plans,
                         path.plans == 1 ? "" : "s");
    case Reached::kCertified:
      return path.grasps == 0 ? "came to a certified plan, of which no grasp was tried"
                              : fmt::format(
                                    "came to a certified plan, and none of {} grasps is "
                                    "feasible",
                                    path.grasps);
    case Reached::kFeasible:
      return fmt::format("came to {} feasible grasp{}, of which {}", progress.feasible,
                         progress.feasible == 1 ? "" : "s",
                         path.lifts == 0 ? "no lift was tried" : "none lifts");
    case Reached::kLifted:
      return fmt::format("came to {} grasp{}, and to no hand motion{}", progress.lifted,
                         progress.lifted == 1 ? " that lifts" : "s that lift",
                         path.moved ? " without a failed frame" : ", as none was tried");
    case Reached::kMoved:
      return "came to a hand motion, after which a neighbour is disturbed";
    case Reached::kOk:
      return "came all the way";
  }
  return "";
}

}  // namespace

Explanation ExplainCertificateAgainst(const Scene& scene, const std::string& id,
                                      const CertifyFacts& facts, const std::string& other_id,
                                      const CertifyFacts& other, const CertifyConfig& config) {
  const Explanation own = ExplainCertificate(scene, facts, config);
  Explanation why;
  why.items = PairItems(own, ExplainCertificate(scene, other, config));
  const auto worlds = [](const CertifyFacts& of) { return of.robust ? of.robust->held : 0; };
  const auto known = [](const CertifyFacts& of) {
    return of.robust ? std::optional<double>(of.robust->held) : std::nullopt;
  };
  if (known(facts) || known(other)) {
    why.items.push_back({"worlds_held", known(facts), known(other), {}});
  }
  why.verdict = Standing(std::pair(facts.certified, worlds(facts)),
                         std::pair(other.certified, worlds(other)));
  if (facts.certified != other.certified) {
    const bool own_fails = !facts.certified;
    why.text = fmt::format("{} is not certified ({}) and {} is", own_fails ? id : other_id,
                           JoinReasons(own_fails ? facts.reasons : other.reasons),
                           own_fails ? other_id : id);
  } else if (facts.certified) {
    why.text = fmt::format("{} and {} are both certified", id, other_id);
  } else {
    why.text = fmt::format("Neither {} ({}) nor {} ({}) is certified", id,
                           JoinReasons(facts.reasons), other_id, JoinReasons(other.reasons));
  }
  AddDifferences(why);
  return why;
}

Explanation ExplainGraspAgainst(const GraspWithLift& grasp, const GraspWithLift& other) {
  const GraspFacts &own = *grasp.grasp, &against = *other.grasp;
  Explanation why;
  why.items = PairItems(ExplainGrasp(own, grasp.lift), ExplainGrasp(against, other.lift));
  const std::string name = fmt::format("Grasp {}", own.entry),
                    other_name = fmt::format("grasp {}", against.entry);
  if (own.entry == against.entry && own.path == against.path) {
    why.verdict = "same";
    why.text = fmt::format("{} is that grasp", name);
    return why;
  }
  if (own.feasible != against.feasible) {
    why.verdict = own.feasible ? "before" : "behind";
    why.text =
        own.feasible
            ? fmt::format("{} is feasible and {} is not: {}", name, other_name, against.sentence)
            : fmt::format("{} is not feasible and {} is: {}", name, other_name, own.sentence);
    return why;
  }
  if (!own.feasible || grasp.lift == nullptr || other.lift == nullptr) {
    why.verdict = "alike";
    why.text = own.feasible ? fmt::format("{} and {} are feasible, and not both were lifted", name,
                                          other_name)
                            : fmt::format("Neither {} nor {} is feasible: {}; {}", name, other_name,
                                          own.sentence, against.sentence);
    return why;
  }
  const std::vector<GraspCriterion> criteria = CompareLifts(own, *grasp.lift, against, *other.lift);
  const auto decides = std::find_if(criteria.begin(), criteria.end(),
                                    [](const auto& one) { return one.own != one.other; });
  for (const GraspCriterion& one : criteria) {
    if (std::string(one.name) != "margin") why.items.push_back({one.name, one.own, one.other, {}});
  }
  if (decides == criteria.end()) {
    why.verdict = own.entry < against.entry ? "before" : "behind";
    why.text = fmt::format(
        "{} comes {} {}: all that a choice goes by is the same, and the lower "
        "number goes first",
        name, own.entry < against.entry ? "before" : "after", other_name);
    return why;
  }
  const bool before = decides->own > decides->other;
  why.verdict = before ? "before" : "behind";
  why.text = fmt::format("{} comes {} {}, as {} ({}: {:.4g} against {:.4g})", name,
                         before ? "before" : "after", other_name,
                         before ? decides->better : decides->worse, Spaced(decides->name),
                         decides->own, decides->other);
  return why;
}

Explanation ExplainFrameAgainst(const FrameFacts& frame, const FrameFacts& other,
                                const MotionConfig& config) {
  const Explanation own = ExplainFrame(frame, config), against = ExplainFrame(other, config);
  const auto rung = [](const FrameFacts& of) {
    int number = 0;
    while (number < kNumLooseningRungs &&
           of.loosened != LooseningRungName(static_cast<LooseningRung>(number))) {
      ++number;
    }
    return number;
  };
  Explanation why;
  why.items = PairItems(own, against);
  why.items.push_back(
      {"rung", static_cast<double>(rung(frame)), static_cast<double>(rung(other)), {}});
  why.verdict =
      Standing(std::pair(!frame.failed, -rung(frame)), std::pair(!other.failed, -rung(other)));
  why.text = own.text + ". " + against.text;
  return why;
}

Explanation ExplainMotionAgainst(const MotionFacts& motion, const MotionFacts& other) {
  Explanation why;
  why.items = PairItems(ExplainMotionEnd(motion), ExplainMotionEnd(other));
  const auto key = [](const MotionFacts& of) {
    return std::tuple(of.failed == 0, -of.failed, -of.over_limits, -of.loosened);
  };
  why.verdict = Standing(key(motion), key(other));
  why.text = fmt::format("Of {} frames {} fail, of the other's {} {}", motion.frames, motion.failed,
                         other.frames, other.failed);
  AddDifferences(why);
  return why;
}

Explanation ExplainPathOf(const Timeline& timeline, const Timeline::Node& end) {
  const int rank = PathOfStep(end.facts);
  Explanation why;
  if (rank < 0) return why;
  const PathProgress path = FollowPath(timeline, rank);
  why.items = {{"plans", static_cast<double>(path.plans), {}, {}},
               {"certified", static_cast<double>(path.certified), {}, {}},
               {"feasible", static_cast<double>(path.furthest->progress.feasible), {}, {}},
               {"lifting", static_cast<double>(path.furthest->progress.lifted), {}, {}}};
  why.text = rank == 0 ? fmt::format("The path by hand {}", DescribePath(path))
                       : fmt::format("Path {} {}", rank, DescribePath(path));
  return why;
}

Explanation ExplainPathAgainstEnd(const Timeline& timeline, const Timeline::Node& end, int rank) {
  const int winner = PathOfStep(end.facts);  // -1 for a step of no path
  const PathProgress own = FollowPath(timeline, rank),
                     other = winner < 0 ? PathProgress() : FollowPath(timeline, winner);
  Explanation why;
  const auto add = [&](const char* name, const auto& value) {
    ReasonItem item{name, {}, {}, {}};
    if (own.furthest != nullptr) item.value = value(own);
    if (other.furthest != nullptr) item.other = value(other);
    if (item.value || item.other) why.items.push_back(item);
  };
  using Number = std::optional<double>;
  add("screened", [](const PathProgress& of) {
    return of.screened == nullptr ? Number() : Number(of.screened->value);
  });
  add("best_cost", [](const PathProgress& of) {
    return of.optimised == nullptr ? Number() : Number(of.optimised->best_cost);
  });
  add("plans", [](const PathProgress& of) { return Number(of.plans); });
  add("certified", [](const PathProgress& of) { return Number(of.certified); });
  add("feasible", [](const PathProgress& of) { return Number(of.furthest->progress.feasible); });
  add("lifting", [](const PathProgress& of) { return Number(of.furthest->progress.lifted); });
  if (rank == winner) {
    why.verdict = "same";
    why.text =
        fmt::format("The end, {}, is of path {}, which {}", end.id(), rank, DescribePath(own));
    return why;
  }
  const Progress nothing;
  const auto progress = [&](const PathProgress& of) {
    return of.furthest == nullptr ? nothing : of.furthest->progress;
  };
  why.verdict = Standing(progress(own), progress(other));
  why.text = fmt::format("Path {} {}", rank, DescribePath(own));
  if (other.furthest != nullptr) {
    why.text += fmt::format(". The end, {}, is of path {}, which {}", end.id(), winner,
                            DescribePath(other));
  } else {
    why.text += fmt::format(". The end is {}, of no path", end.id());
  }
  if (own.furthest != nullptr && why.verdict != "worse")
    why.text += "; of those that come as far the first is taken";
  return why;
}

}  // namespace pregrasp
