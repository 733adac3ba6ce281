#pragma once

#include <array>
#include <vector>

#include "app/hand/ik.h"
#include "app/trajectory/simulate_plan.h"

namespace pregrasp {

enum class MotionPhase { kApproach, kContact, kClosing, kLift };
const char* MotionPhaseName(MotionPhase phase);

/// What the hand has to do at one moment of the animation.
struct MotionFrameTask {
  double t = 0.0;  ///< [s]
  MotionPhase phase = MotionPhase::kApproach;
  std::vector<RigidTransform> X_WB;                        ///< of the scene's bodies
  std::array<Placement::Contact, kNumFingers> contacts{};  ///< on the object, in its frame
};

/// The whole animation as demands on its frames, and which frames are keyframes.
struct MotionTask {
  std::vector<MotionFrameTask> frames;
  std::vector<int> keyframes;  ///< ascending; the first and the last frame among them
};

/// The simulated lift that the animation ends in.
struct MotionLift {
  const std::vector<TraceRow>& trace;  ///< every step, from the end of the certified trajectory on
  double lift_t = 0.0;                 ///< when the fingers have closed and the lift begins [s]
};

struct MotionTiming {
  double fps = 30.0;
  double approach_seconds = 1.2;
  double closing_seconds = 1.0;
};

/// Lays out the animation: approach to the first contact state with the object at rest, the
/// certified trajectory at the speed of the physics, closing of the remaining fingers while the
/// bodies move as they do in the simulated lift until `lift.lift_t`, then the lift and its hold at
/// the speed of the physics. Keyframes are the ends of these phases and every frame at which a
/// finger makes or breaks contact (paper, section "Hand motion synthesis").
MotionTask BuildMotionTask(const World& world, const std::vector<TraceRow>& trace,
                           const MotionLift& lift, const MotionTiming& timing);

/// The inverse-kinematics problem of a frame, without warm start and reference.
IkProblem MakeIkProblem(const MotionFrameTask& frame);

}  // namespace pregrasp
