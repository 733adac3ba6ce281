#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/core/number_range.h"
#include "app/job/run_summary.h"
#include "app/job/timeline.h"

namespace pregrasp {

struct RunConfig {
  static constexpr NumberRange kPaths{1, 1000, 1};

  int paths = 10;    ///< full optimisations at most, of kPaths (design: the budget)
  bool all = false;  ///< go on to the last path after the first success
  int motions = 6;   ///< lifting grasps of one path whose hand motion is tried
  int plans = 4;     ///< of one path that are certified, their ends differing, and more until one
                     ///< has a grasp that lifts: of those with at least half as many as any, the
                     ///< one that holds in most worlds is taken on
  /// Of the planner, by full name, from the graph on; where they are those of the job, none.
  nlohmann::json settings = nlohmann::json::object();

  void Validate() const;
};

/// Where a run is: `done` of `total` pieces of `stage`.
struct RunProgress {
  std::string stage;
  int done = 0, total = 0;
};

/// Where a run ended.
struct RunResult {
  const Timeline::Node* end = nullptr;  ///< the node that the summary is of
  std::string status;
  /// One sentence for each path that was tried: how far it came and what stood in the way.
  std::vector<std::string> reasons;
};

/// The whole pipeline (paper, Figure 2) as commands to a timeline: the start's verdict, graph,
/// screening unless the order is the paper's (ScreenPaths), then path after path until one ends in
/// a certified trajectory, a grasp whose lift is held and a hand motion without a failed frame.
/// @throws Interrupted, with what was done in the timeline.
RunResult RunPlanner(Timeline& timeline, const RunConfig& config,
                     const std::function<void(const RunProgress&)>& progress);

/// Gives the first paths a few rollouts each, the better half of them more, and so on
/// (ScreenConfig).
/// @returns the last node of each path: first those that came furthest, of these the best value,
/// then the better rank. Fewer than there are, where enough are clear before.
std::vector<const Timeline::Node*> ScreenPaths(
    Timeline& timeline, const Timeline::Node& graph,
    const std::function<void(const RunProgress&)>& progress);

// The parts of it that a script calls too, each from one node to the last one of what it did.

/// Prunes until nothing is left to prune.
const Timeline::Node& PruneAll(Timeline& timeline, const Timeline::Node& scored,
                               nlohmann::json options);

/// Takes all samples of a certified trajectory as steps, then lifts the feasible ones.
const Timeline::Node& CompleteGrasps(Timeline& timeline, const Timeline::Node& certified,
                                     nlohmann::json options);

/// The grasps whose lift was simulated, the most promising first, by number: what they withstand,
/// then the generator's before the search's, then the margin. `state` is after CompleteGrasps.
std::vector<int> OrderGrasps(const JobState& state);

/// Solves the keyframes that are left of a motion that has begun and the frames between them, and
/// smooths, whether there is hope of a motion without failure or not.
const Timeline::Node& FinishMotion(Timeline& timeline, const Timeline::Node& node);

/// Shows every frame of a finished motion as a step. @returns the last one.
const Timeline::Node& ShowFrames(Timeline& timeline, const Timeline::Node& finished);

}  // namespace pregrasp
