#pragma once

#include <vector>

#include "app/scene/scene.h"

namespace pregrasp {

/// Two bodies of a scene that overlap at the start by more than the tolerance.
struct Overlap {
  int body_a = 0, body_b = 0;  ///< scene indices, a < b
  double depth = 0.0;          ///< how deep the surface of one lies inside the other [m]
};

/// All overlapping pairs in which at least one body is movable, deepest first. FCL decides whether
/// two shapes meet (solids for primitives, surfaces for meshes; a mesh around or inside the other
/// body is found by signed distance); the depth is then the largest over both surfaces of the
/// signed distance into the other body, searched from many points. Bodies that only touch, or
/// overlap by no more than `tolerance` [m], do not count.
std::vector<Overlap> FindOverlaps(const Scene& scene, double tolerance = 5e-5);

}  // namespace pregrasp
