#pragma once

#include <vector>

#include "app/core/math.h"
#include "app/geometry/signed_distance.h"
#include "app/scene/scene.h"

namespace pregrasp {

/// The forearm that a hand would have behind it, which the hand's model leaves out: 3 cm thick,
/// from the wrist to 20 cm behind the palm, along the palm's -z.
class Forearm {
 public:
  /// @param scene  loaded.
  explicit Forearm(const Scene& scene);

  /// Whether it is clear of all bodies.
  /// @param X_WB  of every body, the object first.
  bool IsFree(const std::vector<RigidTransform>& X_WB, const RigidTransform& X_WH) const;

 private:
  std::vector<SignedDistance> bodies_;
};

}  // namespace pregrasp
