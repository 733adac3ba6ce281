#pragma once

#include <functional>
#include <optional>

#include "app/job/run_policy.h"

namespace pregrasp {

/// Where a run is that is taken a step at a time.
struct RunPlace {
  const Timeline::Node* node = nullptr;  ///< that the last of `steps` did or found; null before it
  int steps = 0;
  RunProgress progress;             ///< what comes next
  std::optional<RunResult> result;  ///< once it has ended
};

/// The first `steps` steps of RunPlanner, in a timeline where some or all of them may be done
/// already: the policy is asked from its beginning, and finds those. So any number of steps can be
/// asked for in any order, and each gives the same as when all came at once.
/// @param more  called with each step; after its first no, nothing more is done. May be empty.
/// @throws Interrupted, as RunPlanner.
RunPlace TakeRunSteps(Timeline& timeline, const RunConfig& config, int steps,
                      const std::function<bool(const RunPlace&)>& more);

}  // namespace pregrasp
