#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/motion/motion_task.h"

namespace pregrasp {

/// In which order keyframes are solved; each is warm-started from the one solved before it. The
/// paper solves the most constrained one, the last, first.
enum class KeyframeOrder { kReverse, kForward };
/// "reverse", "forward".
const char* KeyframeOrderName(KeyframeOrder order);

/// What may be given up, in this order, when a frame has no strict solution; each rung keeps what
/// the rungs before it gave up. The surroundings are never entered.
enum class LooseningRung {
  kNone,          ///< 0.5 mm at the tips, 60 degree cones, no overlap
  kTip5mm,        ///< tips within 5 mm
  kCone80,        ///< cones of 80 degrees
  kConeOff,       ///< no cones
  kDepth3mm,      ///< contacting distal links up to 3 mm in the object
  kClearance1mm,  ///< up to 1 mm of overlap of the hand with itself and the object
  kFailed,        ///< not even so: the frame shows the best attempt
};
const char* LooseningRungName(LooseningRung rung);

struct MotionConfig {
  KeyframeOrder order = KeyframeOrder::kReverse;
  double approach_distance = 0.20;  ///< how far off the palm starts [m]
  int keyframe_starts = 25;         ///< restarts of inverse kinematics at a keyframe
  int frame_starts = 4;             ///< and at a frame in between
  int smoothing_sweeps = 6;         ///< each frame drawn to the mean of its neighbours
  IkConfig ik;
};

/// One finished frame.
struct MotionFrame {
  HandConfiguration configuration;
  bool solved = false;  ///< has been computed at all
  LooseningRung rung = LooseningRung::kNone;
  double tip_error = 0.0;  ///< [m]
  double clearance = 0.0;  ///< [m], at most kClearanceSeen
  IkMethod method = IkMethod::kNone;
};

/// Everything known about a motion so far: a copyable value.
struct MotionState {
  std::vector<MotionFrame> frames;
  std::vector<int> solved_keys;  ///< frame indices, in the order of solving
  bool filled = false;           ///< in-betweens done
  int sweeps = 0;                ///< smoothing sweeps done
};

/// Facts about a finished motion.
struct MotionSummary {
  int frames = 0, failed = 0, loosened = 0;
  double max_tip_error = 0.0;    ///< [m]
  double min_clearance = 0.0;    ///< [m]
  double max_joint_speed = 0.0;  ///< [rad/s]
  double max_wrist_speed = 0.0;  ///< [m/s]
};

/// Turns a task into hand poses: keyframes in the configured order, in-betweens around their
/// interpolation, smoothing, each frame certified (paper, section "Hand motion synthesis").
class HandMotion {
 public:
  /// @param solver  for the scene's bodies; outlives this.
  HandMotion(const IkSolver& solver, MotionTask task, const HandConfiguration& grasp,
             const MotionConfig& config, std::uint64_t seed);

  MotionState Start() const;

  /// Solves the next keyframe in order; false when all are done.
  bool SolveKeyframe(MotionState& state) const;
  /// Needs all keyframes.
  void FillInBetweens(MotionState& state) const;
  void Smooth(MotionState& state) const;
  /// All of the above that is still to do.
  void Finish(MotionState& state) const;

  MotionSummary Summarize(const MotionState& state) const;

  const MotionTask& task() const { return task_; }
  const MotionConfig& config() const { return config_; }

 private:
  MotionFrame SolveFrame(int frame, const HandConfiguration& warm_start,
                         const HandConfiguration& reference, int starts) const;
  MotionFrame SolveApproachStart(const HandConfiguration& first_contact) const;
  std::vector<int> KeyframeSequence() const;

  const IkSolver& solver_;
  MotionTask task_;
  HandConfiguration grasp_;
  MotionConfig config_;
  std::uint64_t seed_;
};

}  // namespace pregrasp
