#pragma once

#include "app/core/rng.h"
#include "app/hand/hand_kinematics.h"

namespace pregrasp {

/// Uniform inside the joint limits.
inline HandJoints RandomJoints(const HandModel& hand, Rng& rng) {
  HandJoints q = HandJoints::Zero();
  for (int j = 0; j < hand.num_joints; ++j) q[j] = rng.Uniform(hand.q_lower[j], hand.q_upper[j]);
  return q;
}

/// Anywhere within half a metre, in any orientation.
inline HandConfiguration RandomConfiguration(const HandModel& hand, Rng& rng) {
  HandConfiguration configuration;
  const Quaternion q_WH = rng.Rotation();
  const Vector3 p_WH(rng.Uniform(-0.5, 0.5), rng.Uniform(-0.5, 0.5), rng.Uniform(-0.5, 0.5));
  configuration.X_WH = MakeTransform(q_WH, p_WH);
  configuration.q = RandomJoints(hand, rng);
  return configuration;
}

}  // namespace pregrasp
