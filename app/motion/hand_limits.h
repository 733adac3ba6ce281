#pragma once

#include <vector>

#include "app/hand/hand_model.h"

namespace pregrasp {

/// How fast a hand may go. Joint speeds are the hand's own (its URDF).
struct HandLimits {
  double wrist_speed = 1.0;             ///< [m/s]
  double wrist_turn_speed = 3.0;        ///< [rad/s]
  double wrist_acceleration = 5.0;      ///< [m/s^2]
  double wrist_turn_acceleration = 20;  ///< [rad/s^2]
  double joint_acceleration = 40.0;     ///< [rad/s^2]
};

/// How fast a hand goes: the largest values over some frames.
struct HandRates {
  double wrist_speed = 0.0;              ///< [m/s]
  double wrist_turn_speed = 0.0;         ///< [rad/s]
  double joint_speed = 0.0;              ///< [rad/s]
  double wrist_acceleration = 0.0;       ///< [m/s^2]
  double wrist_turn_acceleration = 0.0;  ///< [rad/s^2]
  double joint_acceleration = 0.0;       ///< [rad/s^2]
  /// The largest share of a limit, of speeds and of accelerations: at most 1 within them.
  double speed_share = 0.0, acceleration_share = 0.0;

  bool IsWithinLimits() const { return speed_share <= 1.0 && acceleration_share <= 1.0; }
  void Include(const HandRates& other);
};

/// The rates at frame i of a motion at `fps` frames a second that begins and ends at rest: the
/// speed of the step to it, and the change of speed from that step to the one after it.
HandRates CalcRates(const HandModel& hand, const HandLimits& limits,
                    const std::vector<HandConfiguration>& frames, int i, double fps);

}  // namespace pregrasp
