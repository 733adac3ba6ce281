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

/// The grasp that the animation ends in, the object at its final pose.
struct MotionGrasp {
  std::array<Placement::Contact, kNumFingers> contacts{};
  HandConfiguration configuration;
};

struct MotionTiming {
  double fps = 30.0;
  double approach_seconds = 1.2;
  double closing_seconds = 1.0;
  double lift_seconds = 1.2;
  double lift_height = 0.10;  ///< [m]
};

/// Lays out the animation: approach to the first contact state with the object at rest, the
/// certified trajectory at the speed of the physics, closing of the remaining fingers, lift along
/// `lift_W` (unit). Keyframes are the ends of these phases and every frame at which a finger makes
/// or breaks contact (paper, section "Hand motion synthesis").
MotionTask BuildMotionTask(const World& world, const std::vector<TraceRow>& trace,
                           const MotionGrasp& grasp, const Vector3& lift_W,
                           const MotionTiming& timing);

/// The inverse-kinematics problem of a frame, without warm start and reference.
IkProblem MakeIkProblem(const MotionFrameTask& frame);

}  // namespace pregrasp
