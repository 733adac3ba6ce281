#pragma once

#include <vector>

#include "app/core/math.h"
#include "app/geometry/signed_distance.h"
#include "app/hand/hand_model.h"
#include "app/scene/scene.h"

namespace pregrasp {

/// The forearm that a hand would have behind it (HandForearm), which its links leave out: the
/// Shadow Hand's is 3 cm thick, from the wrist to 20 cm behind the palm.
class Forearm {
 public:
  /// @param scene  loaded.
  Forearm(const Scene& scene, const HandModel& hand);

  /// Whether it is clear of all bodies.
  /// @param X_WB  of every body, the object first.
  bool IsFree(const std::vector<RigidTransform>& X_WB, const RigidTransform& X_WH) const;

 private:
  HandForearm forearm_;
  std::vector<SignedDistance> bodies_;
};

}  // namespace pregrasp
