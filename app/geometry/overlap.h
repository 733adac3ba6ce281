#pragma once

#include <vector>

#include "app/scene/scene.h"

namespace pregrasp {

/// Two bodies of a scene that overlap at the start by more than the tolerance, by FCL.
struct Overlap {
  int body_a = 0, body_b = 0;
  double depth = 0.0;  ///< [m]
};

/// All overlapping pairs in which at least one body is movable, deepest first.
std::vector<Overlap> FindOverlaps(const Scene& scene, double tolerance = 5e-5);

}  // namespace pregrasp
