#pragma once

#include <vector>

#include "app/dynamics/world.h"
#include "app/geometry/signed_distance.h"

namespace pregrasp {

/// Honesty rule 4: a fingertip sphere may overlap the environment by at most this [m].
inline constexpr double kTipOverlapAllowed = 3e-4;

/// How deep the sphere of a finger that is on overlaps the surroundings [m]; negative: how far off
/// it is. The sphere touches the finger's point from outside the object.
/// @param radius  of the sphere [m]. @param X_WB  of all bodies, the object first.
inline double CalcTipOverlap(const WorldState& state, Finger finger, double radius,
                             const std::vector<RigidTransform>& X_WB,
                             const EnvironmentDistance& environment) {
  const FingertipState& tip = state.fingers[static_cast<int>(finger)];
  const Vector3 p_WTip = tip.p_WF + radius * (X_WB.front().linear() * tip.nhat_O);
  return radius - environment.Calc(p_WTip, X_WB).phi;
}

}  // namespace pregrasp
