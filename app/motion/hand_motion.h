#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "app/hand/forearm.h"
#include "app/motion/detour.h"
#include "app/motion/hand_limits.h"
#include "app/motion/motion_task.h"
#include "app/motion/smooth_motion.h"

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
  kFailed,        ///< not even so, or the way to it is not free: it shows the best attempt
};
inline constexpr int kNumLooseningRungs = 7;
const char* LooseningRungName(LooseningRung rung);
/// What a frame on a rung asks for.
IkConfig LoosenIk(IkConfig config, LooseningRung rung);

struct MotionConfig {
  KeyframeOrder order = KeyframeOrder::kReverse;
  double approach_distance = 0.20;  ///< how far off the palm starts [m]
  int keyframe_starts = 25;         ///< restarts of inverse kinematics at a keyframe
  int frame_starts = 4;             ///< and at a frame in between
  /// How much room is asked for while a motion is smoothed [m]: what smoothing leaves of it, and
  /// what curved ways between frames take, is still some.
  double smoothing_clearance = 1.6e-3;
  /// Free parts are given the time in which the hand keeps to this share of its limits.
  double pace = 0.9;
  HandLimits limits;
  SmoothingConfig smoothing;
  DetourConfig detour;
  IkConfig ik;
};

/// One finished frame.
struct MotionFrame {
  HandConfiguration configuration;
  bool solved = false;  ///< has been computed at all
  LooseningRung rung = LooseningRung::kNone;
  /// The way from the frame before is free of overlap (CheckWay).
  bool way_clear = true;
  double tip_error = 0.0;             ///< [m]
  double clearance = 0.0;             ///< [m], at most kClearanceSeen
  IkMethod method = IkMethod::kNone;  ///< of what smoothing began with

  bool failed() const { return !solved || rung == LooseningRung::kFailed || !way_clear; }
};

/// Everything known about a motion so far: a copyable value.
struct MotionState {
  /// Laid out as it stands: with the in-betweens, free parts get the time that the hand needs.
  std::shared_ptr<const MotionTask> task;
  std::vector<MotionFrame> keys;    ///< by keyframe
  std::vector<int> solved_keys;     ///< of these, in the order of solving
  std::vector<MotionFrame> frames;  ///< of the task, once filled
  std::vector<DetourKind> detours;  ///< of free intervals and transits, in time, once filled
  bool filled = false;              ///< in-betweens done
  bool finished = false;            ///< smoothed, timed and checked
  int iterations = 0;               ///< of smoothing

  /// No motion without failure can come of it any more: a keyframe has no pose, or a way that the
  /// hand has all the time for is blocked.
  bool is_hopeless() const;
};

/// Of a filled motion: whether the forearm behind the hand is clear of all bodies in every frame.
bool IsForearmFree(const Forearm& forearm, const MotionState& state);

std::vector<HandConfiguration> ConfigurationsOf(const std::vector<MotionFrame>& frames);

/// Facts about a filled motion.
struct MotionSummary {
  int frames = 0;
  int failed = 0;        ///< without a pose, or with a way to it that goes through something
  int blocked_ways = 0;  ///< of these, the latter
  int loosened = 0;
  double max_tip_error = 0.0;  ///< [m]
  double min_clearance = 0.0;  ///< [m]
  HandRates rates;
  std::array<HandRates, kNumMotionPhases> phase_rates;
  int over_limits = 0;  ///< frames at which a limit is exceeded
};

/// Turns a task into hand poses (paper, section "Hand motion synthesis", and more): keyframes in
/// the configured order; in-betweens, in free parts along a way without collision; then the motion
/// as a whole is smoothed, its free parts timed, and every frame and every way between two
/// certified.
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
  /// Needs the in-betweens; smooths, times the free parts and checks.
  void Smooth(MotionState& state) const;
  /// All of the above that is still to do.
  void Finish(MotionState& state) const;

  MotionSummary Summarize(const MotionState& state) const;

  /// As it is at the start: free intervals have one step.
  const MotionTask& task() const { return *task_; }
  const MotionConfig& config() const { return config_; }

 private:
  MotionFrame SolveFrame(const MotionFrameTask& task, const HandConfiguration& warm_start,
                         const HandConfiguration& reference, int starts, const Rng& rng) const;
  MotionFrame SolveStrictly(const MotionFrameTask& task, const HandConfiguration& warm_start,
                            const HandConfiguration& reference, const Rng& rng) const;
  MotionFrame SolveApproachStart(const HandConfiguration& first_contact) const;
  DetourProblem MakeDetour(const MotionFrameTask& begin, const MotionFrameTask& end,
                           const HandConfiguration& from, const HandConfiguration& to) const;
  std::vector<int> KeyframeSequence() const;
  bool IsIdle(const MotionTask& task, int interval) const;
  bool FillAlongWay(MotionState& state, int interval) const;
  void FillTimed(MotionState& state, int interval) const;

  const IkSolver& solver_;
  std::shared_ptr<const MotionTask> task_;
  HandConfiguration grasp_;
  MotionConfig config_;
  std::uint64_t seed_;
};

}  // namespace pregrasp
