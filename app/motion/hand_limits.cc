#include "app/motion/hand_limits.h"

#include <algorithm>
#include <cmath>

#include "app/hand/hand_kinematics.h"

namespace pregrasp {

void HandRates::Include(const HandRates& other) {
  const auto raise = [](double& mine, double theirs) { mine = std::max(mine, theirs); };
  raise(wrist_speed, other.wrist_speed);
  raise(wrist_turn_speed, other.wrist_turn_speed);
  raise(joint_speed, other.joint_speed);
  raise(wrist_acceleration, other.wrist_acceleration);
  raise(wrist_turn_acceleration, other.wrist_turn_acceleration);
  raise(joint_acceleration, other.joint_acceleration);
  raise(speed_share, other.speed_share);
  raise(acceleration_share, other.acceleration_share);
}

HandRates CalcRates(const HandModel& hand, const HandLimits& limits,
                    const std::vector<HandConfiguration>& frames, int i, double fps) {
  const int last = static_cast<int>(frames.size()) - 1;
  HandVector before = HandVector::Zero();
  HandVector after = HandVector::Zero();
  if (i > 0) before = fps * CalcStep(frames[i - 1], frames[i]);
  if (i < last) after = fps * CalcStep(frames[i], frames[i + 1]);
  const HandVector change = fps * (after - before);
  HandRates rates;
  rates.wrist_speed = before.head<3>().norm();
  rates.wrist_turn_speed = before.segment<3>(3).norm();
  rates.joint_speed = before.tail<kMaxHandJoints>().cwiseAbs().maxCoeff();
  rates.wrist_acceleration = change.head<3>().norm();
  rates.wrist_turn_acceleration = change.segment<3>(3).norm();
  rates.joint_acceleration = change.tail<kMaxHandJoints>().cwiseAbs().maxCoeff();
  rates.speed_share = std::max(rates.wrist_speed / limits.wrist_speed,
                               rates.wrist_turn_speed / limits.wrist_turn_speed);
  for (int j = 0; j < hand.num_joints; ++j) {
    rates.speed_share =
        std::max(rates.speed_share, std::abs(before[6 + j]) / hand.joints[j].max_speed);
  }
  rates.acceleration_share =
      std::max({rates.wrist_acceleration / limits.wrist_acceleration,
                rates.wrist_turn_acceleration / limits.wrist_turn_acceleration,
                rates.joint_acceleration / limits.joint_acceleration});
  return rates;
}

}  // namespace pregrasp
