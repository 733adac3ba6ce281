#pragma once

#include <string>
#include <vector>

#include "app/job/scene_facts.h"

namespace pregrasp {

// As in step_facts.h: the hand motion.

/// A frame of a hand motion, a keyframe or not.
struct FrameFacts {
  int path = 0, grasp = 0;
  int frame = 0;     ///< from 1; of a keyframe's step, before free parts were given their time
  int keyframe = 0;  ///< its number among the keyframes in time, from 1; 0 for none
  std::string phase, loosened;
  bool failed = false;
  bool way_clear = true;  ///< the way from the frame before is free of overlap
  double tip_error_mm = 0.0, clearance_mm = 0.0;
  double simulated_t = 0.0;  ///< of the row of rollout.csv or lift.csv that it shows [s]
  HandFacts hand;
  std::vector<PlaceFacts> touching;

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("path", self.path);
    visit("grasp", self.grasp);
    visit("frame", self.frame);
    visit("keyframe", self.keyframe);
    visit("phase", self.phase);
    visit("loosened", self.loosened);
    visit("failed", self.failed);
    visit("way_clear", self.way_clear);
    visit("tip_error_mm", self.tip_error_mm);
    visit("clearance_mm", self.clearance_mm);
    visit("simulated_t", self.simulated_t);
    visit("hand", self.hand);
    visit("touching", self.touching);
  }
};

/// How fast the hand goes: the largest speeds and accelerations of a phase or of the whole motion.
struct RatesFacts {
  std::string phase;
  double joint_speed = 0.0;                            ///< [rad/s]
  double wrist_speed = 0.0;                            ///< [m/s]
  double wrist_turn_speed = 0.0;                       ///< [rad/s]
  double joint_acceleration = 0.0;                     ///< [rad/s^2]
  double wrist_acceleration = 0.0;                     ///< [m/s^2]
  double wrist_turn_acceleration = 0.0;                ///< [rad/s^2]
  double speed_share = 0.0, acceleration_share = 0.0;  ///< the largest of a limit: 1 reaches it

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("phase", self.phase);
    visit("joint_speed", self.joint_speed);
    visit("wrist_speed", self.wrist_speed);
    visit("wrist_turn_speed", self.wrist_turn_speed);
    visit("joint_acceleration", self.joint_acceleration);
    visit("wrist_acceleration", self.wrist_acceleration);
    visit("wrist_turn_acceleration", self.wrist_turn_acceleration);
    visit("speed_share", self.speed_share);
    visit("acceleration_share", self.acceleration_share);
  }
};

/// A motion after its in-betweens or its smoothing.
struct MotionFacts {
  int path = 0, grasp = 0;
  int frames = 0, failed = 0, loosened = 0;
  int blocked_ways = 0;  ///< of the failed frames, those that the way to goes through something
  double seconds = 0.0;  ///< of the animation
  double max_tip_error_mm = 0.0, min_clearance_mm = 0.0;
  bool forearm_free = false;  ///< of all bodies, in every frame
  int over_limits = 0;        ///< frames at which the hand exceeds a limit of speed or acceleration
  RatesFacts rates;
  std::vector<RatesFacts> phases;
  std::vector<std::string> ways;  ///< of the free parts, in time: how each was found
  std::string order;

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("path", self.path);
    visit("grasp", self.grasp);
    visit("frames", self.frames);
    visit("failed", self.failed);
    visit("loosened", self.loosened);
    visit("blocked_ways", self.blocked_ways);
    visit("seconds", self.seconds);
    visit("max_tip_error_mm", self.max_tip_error_mm);
    visit("min_clearance_mm", self.min_clearance_mm);
    visit("forearm_free", self.forearm_free);
    visit("over_limits", self.over_limits);
    visit("rates", self.rates);
    visit("phases", self.phases);
    visit("ways", self.ways);
    visit("order", self.order);
  }
};

}  // namespace pregrasp
