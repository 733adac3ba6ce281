#pragma once

#include <vector>

#include "app/hand/ik.h"
#include "app/motion/hand_limits.h"

namespace pregrasp {

/// What a motion is smoothed by. A residual of 1 weighs as much as a millimetre of tip error or of
/// missing clearance; one unit of a step is 5 cm of the wrist, half a radian of it or of a joint.
struct SmoothingConfig {
  int iterations = 40;         ///< of Gauss-Newton, at most
  double step_weight = 0.3;    ///< of a step from one frame to the next
  double bend_weight = 3.0;    ///< of its change from one step to the next
  double limit_weight = 20.0;  ///< of the share by which a limit is exceeded
  /// Of a limit, what is aimed for: the rest is room for what the smoothing leaves undone.
  double limit_share = 0.95;
};

/// What is asked of the hand at a moment.
struct HandDemand {
  IkConfig config;
  IkProblem problem;
};

struct SmoothingResult {
  int iterations = 0;
  double cost_before = 0.0, cost_after = 0.0;
};

/// Smooths a whole motion: least squares over all frames at once of what inverse kinematics asks of
/// each frame and of the middle of each way between two, of steps and of their changes, and of what
/// exceeds the hand's limits. The first frame stays; the motion begins and ends at rest. Levenberg-
/// Marquardt, with one banded factorisation an iteration.
/// @param demands  of each frame.
/// @param ways     of the middle of each way, one fewer.
/// @param motion   in and out, as many as demands, at least two.
SmoothingResult SmoothMotion(const IkSolver& solver, const std::vector<HandDemand>& demands,
                             const std::vector<HandDemand>& ways, const HandLimits& limits,
                             double fps, const SmoothingConfig& config,
                             std::vector<HandConfiguration>* motion);

}  // namespace pregrasp
