#pragma once

#include <string>

#include "app/motion/hand_motion.h"

namespace pregrasp {

/// The first line of motion.csv, with its line break: t; p_WO_*, q_WO_* (w, x, y, z); p_WH_*,
/// q_WH_*; the 22 joint angles [rad] by the hand's names; FINGER_on (0 or 1) for all five; then
/// clearance_mm, tip_error_mm, and loosened, the rung of the ladder as a number (0 none, 6 failed).
std::string MotionHeader();

/// One line of it.
std::string MotionRow(const MotionFrameTask& task, const MotionFrame& frame);

}  // namespace pregrasp
