#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/pipeline/plan_record.h"

namespace pregrasp {

struct RunConfig {
  int paths = 10;    ///< full optimisations at most, 1 to 1000 (design: the budget)
  bool all = false;  ///< go on to the last path after the first success
  /// Feasible grasps of one path whose hand motion is tried.
  int motions = 4;

  void Validate() const;
};

/// How a run ended: the summary's status.
enum class RunStatus { kOk, kNoFeasibleGrasp, kMotionFailed, kStartGraspable };
/// "ok", "no_feasible_grasp", "motion_failed", "start_graspable".
const char* RunStatusName(RunStatus status);

struct RunResult {
  RunStatus status = RunStatus::kNoFeasibleGrasp;
  /// One sentence for each path that was tried: how far it came and what stood in the way.
  std::vector<std::string> reasons;
};

/// Where a run is: `done` of `total` pieces of `stage`.
struct RunProgress {
  std::string stage;
  int done = 0, total = 0;
};

/// The whole pipeline (paper, Figure 2): graph, then path after path in their order until one ends
/// in a certified trajectory, a feasible grasp and a hand motion without a failed frame. Each step
/// goes to `record`.
/// @throws Interrupted, with what was done recorded.
RunResult RunPlanner(const Planner& planner, PlanRecord& record, const StartCertificate& start,
                     const RunConfig& config,
                     const std::function<void(const RunProgress&)>& progress);

}  // namespace pregrasp
