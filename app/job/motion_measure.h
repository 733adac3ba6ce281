#pragma once

#include <string>

#include "app/dynamics/world.h"

namespace pregrasp {

/// How far bodies went between two states: the furthest centre of mass, the largest turn.
struct Motion {
  double moved = 0.0;    ///< [m], of a centre of mass
  double rotated = 0.0;  ///< [rad]
  std::string body;      ///< the body that moved furthest
};

Motion CalcObjectMotion(const World& world, const WorldState& from, const WorldState& to);

/// At rest means under 1 mm and under 0.5 degrees in 1 s untouched, for every movable body
/// (the project's rule for a start).
inline constexpr double kRestSeconds = 1.0;
inline constexpr double kRestMoved = 1e-3;                 // [m]
inline constexpr double kRestRotated = 0.5 * kPi / 180.0;  // [rad]

struct SettleResult {
  Motion largest;  ///< over all movable bodies and all moments, against the start
  bool at_rest = false;
  int steps = 0;
  int not_converged = 0;    ///< of these, steps that the contact solver left unfinished
  double unresolved = 0.0;  ///< how far bodies may have sunk into each other in these [m]
};

/// Lets the world alone for `seconds`, advancing `state`. @throws Interrupted.
SettleResult Settle(const World& world, WorldState& state, double seconds);

}  // namespace pregrasp
