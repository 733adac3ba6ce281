#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/job/facts_json.h"
#include "app/job/timeline.h"

namespace pregrasp {

/// How two steps, and what led to each, differ: two forks of one job, or two jobs.
struct BranchComparison {
  /// The first thing that differs between the scenes, shapes left aside. None: nothing.
  std::optional<FactsDifference> scene;
  const Timeline::Node* common = nullptr;  ///< the last step that both have, or that says the same
  /// The first steps that differ; null where that branch has ended.
  const Timeline::Node *left = nullptr, *right = nullptr;
  /// What was asked for there: an option, or a setting by its full name. None: the same.
  std::optional<FactsDifference> command;
  /// The first thing that came of it that differs. None: nothing.
  std::optional<FactsDifference> facts;
  /// Both draw the same noise there: the same seed, path and iteration. None: not of MPPI.
  std::optional<bool> same_noise;
  /// Settings that differ at the ends, by full name.
  std::vector<FactsDifference> settings;

  bool same() const { return !scene && left == nullptr && right == nullptr; }
};

/// @param left  a step of `left_timeline`; they may be one.
BranchComparison CompareBranches(const Timeline& left_timeline, const Timeline::Node& left,
                                 const Timeline& right_timeline, const Timeline::Node& right);

}  // namespace pregrasp
