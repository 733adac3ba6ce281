#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/job/branch_comparison.h"
#include "app/page/strip.h"

namespace pregrasp {

/// Where two runs, or two branches of a session, first differ.
struct FirstDifference {
  std::string text;  ///< what differs there, or that nothing does
  // The steps there; null for one that has ended, and both where no step differs.
  const StepFacts *left = nullptr, *right = nullptr;
};

/// By what `pregrasp diff` tells.
FirstDifference FindFirstDifference(const LoadedRun& left, const LoadedRun& right);
/// By what pg.compare tells. @param ends  two steps of these timelines.
FirstDifference FindFirstDifference(const Timeline& left_timeline, const Timeline::Node& left,
                                    const Timeline& right_timeline, const Timeline::Node& right);

/// Two finished runs below each other, in columns: the last step that both have, the first that
/// differ, marked, and from there what both came to: the last iteration, the plan, the grasp or its
/// lift, the end. One camera for all. @param ids  of the columns, in place of these.
/// @throws InputError for an id that neither run has, or a picture too small.
Image DrawPairOfRuns(const LoadedRun& left, const LoadedRun& right,
                     const std::vector<std::string>& ids, const Shot& shot,
                     const std::optional<Vector3>& view);

/// Where a branch of a session ends.
struct BranchEnd {
  const Timeline& timeline;
  const Timeline::Node& node;
  PictureDrawer& drawer;
};
/// Two branches, of one session or of two, likewise.
Image DrawPairOfBranches(const BranchEnd& left, const BranchEnd& right, const Shot& shot);

}  // namespace pregrasp
