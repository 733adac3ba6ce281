#pragma once

#include <vector>

#include "app/core/rng.h"
#include "app/graph/placement.h"

namespace pregrasp {

struct PlacementSearchConfig {
  int points = 400;  ///< candidate contacts a finger, even over the surface
  int pairs = 4000;  ///< candidate placements of both fingers
  double max_tip_distance =
      0.13;               ///< between two contacts [m]: what a hand spans (findings: 13 cm)
  double spacing = 0.01;  ///< placements of the same fingers differ by this much somewhere [m]

  /// @throws InputError for lengths that do not go together.
  void Validate() const;
};

/// The placements with the best scores in the state that `scorer` is bound to, best first, none
/// near another: what a grasp is to be completed from.
/// @param fixed  contacts that every placement has; its other fingers are searched for, and may
///               stay away.
/// @param count  at most so many; fewer where too little of the surface can be touched.
std::vector<Placement> FindPlacements(const TriangleMesh& mesh, const SignedDistance& shape,
                                      const PlacementScorer& scorer, const Placement& fixed,
                                      int count, const PlacementSearchConfig& config, Rng rng);

}  // namespace pregrasp
