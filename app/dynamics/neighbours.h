#pragma once

#include <optional>

#include "app/dynamics/world.h"

namespace pregrasp {

/// How far the movable bodies other than the object have come from where the scene has them.
struct NeighbourMotion {
  /// The one that moved most, 30 degrees counting as much as 5 cm.
  std::optional<BodyIndex> worst;
  double moved = 0.0;       ///< the farthest of all [m]
  double turned_deg = 0.0;  ///< the most of all [degrees]
  double fell = 0.0;        ///< the most that one's origin is below its start [m], along gravity
  /// Turned over 30 degrees or over 5 cm below its start (honesty rule 4).
  bool disturbed = false;
};

NeighbourMotion CalcNeighbourMotion(const World& world, const WorldState& state);

}  // namespace pregrasp
