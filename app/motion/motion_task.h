#pragma once

#include <array>
#include <vector>

#include "app/hand/ik.h"
#include "app/trajectory/simulate_plan.h"

namespace pregrasp {

/// What the hand is about at a moment. Between contact stages no finger may be on: then it is in
/// transit to the next.
enum class MotionPhase { kApproach, kContact, kTransit, kClosing, kLift };
inline constexpr int kNumMotionPhases = 5;
/// "approach", ..: the word in motion.csv, in pictures and in scripts.
const char* MotionPhaseName(MotionPhase phase);

/// What the hand has to do at one moment of the animation.
struct MotionFrameTask {
  double t = 0.0;  ///< [s]
  double simulated_t =
      0.0;  ///< of the simulated row that it shows, as in rollout.csv, lift.csv [s]
  MotionPhase phase = MotionPhase::kApproach;
  std::vector<RigidTransform> X_WB;                        ///< of the scene's bodies
  std::array<Placement::Contact, kNumFingers> contacts{};  ///< on the object, in its frame
  /// The bodies' poses on the way from the frame before: from there to here, as the simulation has
  /// them, evenly spaced. A single entry, `X_WB`, where they stand; none at the first frame.
  std::vector<std::vector<RigidTransform>> X_WB_way;
};

/// The whole animation as demands on its frames, in intervals from keyframe to keyframe.
struct MotionTask {
  std::vector<MotionFrameTask> frames;
  std::vector<int> keyframes;  ///< ascending; the first and the last frame among them
  /// Of each interval, one fewer than keyframes: whether no physics runs in it, so that it may take
  /// as long as the hand needs. Bodies stand in it and fingers that are on stay so.
  std::vector<bool> is_free;
  double fps = 30.0;
  Vector3 up_W = Vector3::UnitZ();  ///< against gravity, unit length

  int num_intervals() const { return static_cast<int>(is_free.size()); }
  /// Of an interval: steps from frame to frame.
  int num_steps(int interval) const { return keyframes[interval + 1] - keyframes[interval]; }
};

/// The same task with another number of steps, at least one, in a free interval.
MotionTask WithSteps(const MotionTask& task, int interval, int steps);

/// The simulated lift that the animation ends in.
struct MotionLift {
  const std::vector<TraceRow>& trace;  ///< every step, from the end of the certified trajectory on
  double closing_t = 0.0;              ///< when the grasp's fingers are put on [s]
  double lift_t = 0.0;                 ///< when they have closed and the lift begins [s]
};

struct MotionTiming {
  double fps = 30.0;
};

/// Lays out the animation. Free: the approach to the first contact state, with the object at rest.
/// Then the certified trajectory at the speed of the physics, but for the end of its hold, from
/// where on nothing moves any more. The hand-over to the grasp at the speed of the physics; free:
/// the way of the fingers that close, to their contacts; then closing and lift with its hold at the
/// speed of the physics. Keyframes are the ends of these parts and the frames before and after
/// every change of the fingers that are on, if any is (paper, section "Hand motion synthesis").
/// Free intervals have one step.
MotionTask BuildMotionTask(const World& world, const std::vector<TraceRow>& trace,
                           const MotionLift& lift, const MotionTiming& timing);

/// The inverse-kinematics problem of a frame, without warm start and reference.
IkProblem MakeIkProblem(const MotionFrameTask& frame);

/// The way of the hand from the frame before `frame`, whose demands are `before`: a finger that is
/// on at either end may touch.
HandWay MakeHandWay(const MotionFrameTask& before, const MotionFrameTask& frame,
                    const HandConfiguration& from, const HandConfiguration& to);

}  // namespace pregrasp
