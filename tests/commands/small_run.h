#pragma once

#include <string>
#include <vector>

namespace pregrasp {

/// The settings of a run of three seconds, as `--set KEY=VALUE`: every stage does a little. Of one
/// second where fingertips.friction=0.1 leaves nothing to lift.
inline std::vector<std::string> SmallRun(const std::vector<std::string>& more = {}) {
  std::vector<std::string> settings = {
      "graph.samples=1",         "screen.paths=4",        "screen.samples=8",
      "mppi.samples=8",          "mppi.iterations=2",     "grasps.samples=2",
      "grasps.max_solves=2",     "grasps.starts=2",       "grasps.max_stiffness_tests=2",
      "grasps.search_sets=4096", "grasps.search_found=1", "motion.keyframe_starts=4",
      "motion.frame_starts=1"};
  settings.insert(settings.end(), more.begin(), more.end());
  std::vector<std::string> arguments;
  for (const std::string& setting : settings) arguments.insert(arguments.end(), {"--set", setting});
  return arguments;
}

}  // namespace pregrasp
