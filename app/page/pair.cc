#include "app/page/pair.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "app/core/json_difference.h"
#include "app/core/text.h"
#include "app/job/facts_json.h"
#include "app/page/run_steps.h"
#include "app/pictures/reasons.h"
#include "app/pictures/words.h"
#include "app/recording/run_comparison.h"

namespace pregrasp {
namespace {

// One of the two: the steps that led to its end.
struct PairBranch {
  std::string name;  // above its pictures
  std::vector<const StepFacts*> way;
  const FactsSource* steps = nullptr;
  PictureDrawer* drawer = nullptr;
};

using Column = std::pair<const StepFacts*, const StepFacts*>;

const StepFacts* ParentOf(const StepFacts* step, const FactsSource& steps) {
  if (step == nullptr || step->command.node.empty()) return nullptr;
  return &steps.Get(step->command.node);
}

const StepFacts* FindLast(const std::vector<const StepFacts*>& way, Verb verb) {
  const auto found = std::find_if(
      way.rbegin(), way.rend(), [&](const StepFacts* step) { return step->command.verb == verb; });
  return found == way.rend() ? nullptr : *found;
}

bool SaysTheSame(const StepFacts* a, const StepFacts* b) {
  return a != nullptr && b != nullptr && a->id == b->id && !CompareContents(*a, *b);
}

std::vector<Column> ChooseColumns(const PairBranch& left, const PairBranch& right,
                                  const FirstDifference& difference) {
  std::vector<Column> columns;
  const auto add = [&](const StepFacts* a, const StepFacts* b) {
    const Column column(a, b);
    if (a == nullptr && b == nullptr) return;
    if (std::find(columns.begin(), columns.end(), column) == columns.end()) {
      columns.push_back(column);
    }
  };
  const StepFacts *before = ParentOf(difference.left, *left.steps),
                  *other_before = ParentOf(difference.right, *right.steps);
  if (difference.left == nullptr) before = left.way.back();
  if (difference.right == nullptr) other_before = right.way.back();
  if (SaysTheSame(before, other_before)) add(before, other_before);
  add(difference.left, difference.right);
  const auto add_outcome = [&](const StepFacts* a, const StepFacts* b) {
    if (!SaysTheSame(a, b)) add(a, b);
  };
  add_outcome(FindLast(left.way, Verb::kIterate), FindLast(right.way, Verb::kIterate));
  add_outcome(FindLast(left.way, Verb::kCertify), FindLast(right.way, Verb::kCertify));
  const StepFacts *lift = FindLift(left.way), *other_lift = FindLift(right.way);
  if (lift != nullptr || other_lift != nullptr) {
    add_outcome(lift, other_lift);
  } else {
    add_outcome(FindGrasp(left.way), FindGrasp(right.way));
  }
  add_outcome(left.way.back(), right.way.back());
  if (columns.empty()) add(left.way.back(), right.way.back());
  return columns;
}

Image DrawColumns(const PairBranch& left, const PairBranch& right,
                  const FirstDifference& difference, const std::vector<Column>& columns,
                  const Shot& shot, const std::optional<Vector3>& view) {
  constexpr int kLines = 6;
  std::vector<StripStep> steps;
  steps.reserve(2 * columns.size());
  for (const Column& column : columns) steps.push_back({column.first, left.steps, left.drawer});
  for (const Column& column : columns) steps.push_back({column.second, right.steps, right.drawer});
  PictureGrid grid;
  grid.heading = difference.text;
  grid.cells = MakeCells(steps, shot, view);
  grid.columns = static_cast<int>(columns.size());
  grid.row_names = {left.name, right.name};
  grid.most_lines = kLines;
  grid.width = shot.config.width;
  grid.height = shot.config.height;
  grid.font_scale = shot.config.font_scale;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    PictureGrid::Cell& cell = grid.cells[i];
    const StepFacts* step = steps[i].step;
    if (step == nullptr) cell.title = "none";
    cell.marked = step != nullptr && (step == difference.left || step == difference.right);
  }
  return DrawGrid(grid);
}

PairBranch MakeBranch(const char* letter, const LoadedRun& run, const LoadedRun& other,
                      PictureDrawer& drawer) {
  PairBranch branch;
  branch.way = RunSteps(run).way();
  branch.steps = &run;
  branch.drawer = &drawer;
  branch.name =
      fmt::format("{}: {}, {}, seed {}, {}", letter, run.directory.string(), run.scene.name,
                  run.summary.seed, run.summary.status.value_or("unfinished"));
  constexpr int kMost = 4;
  int count = 0;
  const auto configuration = [](const LoadedRun& of) {
    return nlohmann::ordered_json(of.manifest.value("configuration", nlohmann::json::object()));
  };
  VisitDifferences(configuration(run), configuration(other), [&](const JsonDifference& setting) {
    branch.name += fmt::format(", {} {}", setting.field, OneLine(setting.left));
    return ++count < kMost;
  });
  return branch;
}

const StepFacts* FindStep(const LoadedRun& run, const std::string& id) {
  const auto found = run.number_of.find(id);
  return found == run.number_of.end() ? nullptr
                                      : &run.steps[static_cast<std::size_t>(found->second) - 1];
}

}  // namespace

FirstDifference FindFirstDifference(const LoadedRun& left, const LoadedRun& right) {
  RunComparison comparison(0.0);
  comparison.CompareRuns(left.directory, right.directory);
  if (!comparison.first()) return {"Every step and every file the same.", nullptr, nullptr};
  RunDifference first = *comparison.first();
  first.value = {DescribeField(first.value.field),
                 DescribeValue(first.value.left, first.value.right),
                 DescribeValue(first.value.right, first.value.left), first.value.distance};
  FirstDifference difference{"The first difference: " + first.Sentence("A", "B") + ".", nullptr,
                             nullptr};
  // Steps are compared line by line, and named by the right one's id; where one run has more, the
  // first of these.
  const std::string& place = comparison.first()->place;
  const StepFacts* named = FindStep(right, place);
  std::size_t i = std::min(left.steps.size(), right.steps.size());
  if (named != nullptr) {
    i = static_cast<std::size_t>(named - right.steps.data());
  } else if (place != "steps.jsonl") {
    return difference;
  }
  if (i < left.steps.size()) difference.left = &left.steps[i];
  if (i < right.steps.size()) difference.right = &right.steps[i];
  if (difference.left == nullptr || difference.right == nullptr) return difference;
  // What their cards have of it, in the same words.
  constexpr std::size_t kMost = 4;
  const std::string rows =
      DescribeRowDifferences(DescribeStep(left.scene, *difference.left, left),
                             DescribeStep(right.scene, *difference.right, right), kMost);
  if (!rows.empty()) {
    difference.text = fmt::format("The first step that differs, {}, has {}.", place, rows);
  }
  return difference;
}

FirstDifference FindFirstDifference(const Timeline& left_timeline, const Timeline::Node& left,
                                    const Timeline& right_timeline, const Timeline::Node& right) {
  const BranchComparison comparison = CompareBranches(left_timeline, left, right_timeline, right);
  const Explanation why =
      ExplainDifference(comparison, left_timeline.job().scene(), right_timeline.job().scene(),
                        left.facts, right.facts, left_timeline, right_timeline);
  FirstDifference difference{why.text + ".", nullptr, nullptr};
  if (comparison.left != nullptr) difference.left = &comparison.left->facts;
  if (comparison.right != nullptr) difference.right = &comparison.right->facts;
  return difference;
}

Image DrawPairOfRuns(const LoadedRun& left, const LoadedRun& right,
                     const std::vector<std::string>& ids, const Shot& shot,
                     const std::optional<Vector3>& view) {
  std::vector<Column> columns;
  for (const std::string& id : ids) {
    columns.emplace_back(FindStep(left, id), FindStep(right, id));
    if (columns.back().second == nullptr) columns.back().first = &left.Get(id);
  }
  PictureDrawer drawer(left.scene, LabelsOf(left));
  PictureDrawer other_drawer(right.scene, LabelsOf(right));
  const PairBranch a = MakeBranch("A", left, right, drawer),
                   b = MakeBranch("B", right, left, other_drawer);
  const FirstDifference difference = FindFirstDifference(left, right);
  if (columns.empty()) columns = ChooseColumns(a, b, difference);
  return DrawColumns(a, b, difference, columns, shot, view);
}

Image DrawPairOfBranches(const BranchEnd& left, const BranchEnd& right, const Shot& shot) {
  const BranchComparison comparison =
      CompareBranches(left.timeline, left.node, right.timeline, right.node);
  const auto branch_of = [&](const char* letter, const BranchEnd& end,
                             std::string FactsDifference::*value) {
    PairBranch branch;
    branch.name = fmt::format("{}: {}", letter, end.node.id());
    for (const FactsDifference& setting : comparison.settings) {
      branch.name += fmt::format(", {} {}", setting.field, OneLine(setting.*value));
    }
    for (const Timeline::Node* node : PathTo(end.node)) branch.way.push_back(&node->facts);
    branch.steps = &end.timeline;
    branch.drawer = &end.drawer;
    return branch;
  };
  const PairBranch a = branch_of("A", left, &FactsDifference::left),
                   b = branch_of("B", right, &FactsDifference::right);
  const FirstDifference difference =
      FindFirstDifference(left.timeline, left.node, right.timeline, right.node);
  return DrawColumns(a, b, difference, ChooseColumns(a, b, difference), shot, std::nullopt);
}

}  // namespace pregrasp
