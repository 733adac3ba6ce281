#pragma once

#include <array>
#include <string>
#include <vector>

#include "app/hand/hand_model.h"
#include "app/motion/hand_motion.h"
#include "app/scene/scene.h"

namespace pregrasp {

/// What an animation shows at a frame.
struct AuditFrame {
  double t = 0.0;
  MotionPhase phase = MotionPhase::kApproach;
  std::vector<RigidTransform> X_WB;  ///< of all bodies, the object first
  HandConfiguration hand;
  std::array<bool, kNumFingers> on{};
};

/// The frames of a finished motion.
std::vector<AuditFrame> FramesOf(const MotionState& state);

/// The largest rates of a phase: wrist [m/s, rad/s, m/s^2, rad/s^2], joints [rad/s, rad/s^2].
struct AuditRates {
  double wrist = 0.0, turn = 0.0, joint = 0.0;
  double wrist_acceleration = 0.0, turn_acceleration = 0.0, joint_acceleration = 0.0;
  int over = 0;          ///< frames beyond a limit
  double share = 0.0;    ///< the largest of a limit
  std::string limiting;  ///< of what
  int frames = 0;
};

struct MotionAudit {
  int frames = 0;
  int bad_frames = 0;          ///< with an overlap beyond what contacts allow
  double worst_frame = 0.0;    ///< the deepest [m]
  int bad_ways = 0;            ///< between two frames, at ten times the rate
  double worst_way = 0.0;      ///< [m]
  std::string worst_pair;      ///< of all, with its frame
  int out_of_range = 0;        ///< frames with a joint beyond its range
  double worst_jump = 0.0;     ///< of the wrist from one frame to the next [rad]
  double longest_still = 0.0;  ///< time in which nothing of the hand moves by 0.2 mm a frame [s]
  std::array<AuditRates, kNumMotionPhases> rates;

  bool IsFree() const { return bad_frames == 0 && bad_ways == 0; }
};

/// Checks an animation at ten times its frame rate, from what a viewer sees alone: poses
/// interpolated between frames. Independent of the planner's kinematics and distances: Simbody's
/// poses of the links, points sampled along the capsules against the signed distance of whole
/// shapes. A finger that is on at either end may enter the object by 1 mm; anything else by
/// `slack`.
MotionAudit AuditMotion(const HandModel& hand, const Scene& scene,
                        const std::vector<AuditFrame>& frames, double slack = 2e-5);

}  // namespace pregrasp
