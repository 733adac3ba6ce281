#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "app/motion/hand_motion.h"

namespace pregrasp {

/// The first line of motion.csv, with its line break: t; p_WO_*, q_WO_* (w, x, y, z); p_WH_*,
/// q_WH_*; the joint angles [rad] by the hand's names; FINGER_on (0 or 1) for all fingers; phase
/// (MotionPhaseName); then clearance_mm, tip_error_mm, and loosened, the rung of the ladder as a
/// number (0 none, 6 failed); simulated_t, the time of the row of rollout.csv, or past its end of
/// lift.csv, whose poses the line has: it stands still while only the hand moves.
std::string MotionHeader(const HandModel& hand);

/// One line of it.
std::string MotionRow(const HandModel& hand, const MotionFrameTask& task, const MotionFrame& frame);

/// A line of motion.csv read back.
struct MotionRecord {
  double t = 0.0;  ///< [s]
  RigidTransform X_WO = RigidTransform::Identity();
  HandConfiguration hand;
  std::array<bool, kNumFingers> on{};
  MotionPhase phase = MotionPhase::kApproach;
  double clearance_mm = 0.0, tip_error_mm = 0.0;
  LooseningRung rung = LooseningRung::kNone;
  double simulated_t = 0.0;  ///< [s]
};

/// All lines of a motion.csv of that hand. @throws InputError with the file, its line and what was
/// expected.
std::vector<MotionRecord> ReadMotionTable(const std::filesystem::path& file, const HandModel& hand);

}  // namespace pregrasp
