#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/hand/distance.h"

namespace pregrasp {

/// A collision found by FCL: a capsule with another capsule or a body.
struct HandCollision {
  HandPair pair = HandPair::kSelf;
  int capsule = 0;
  int other = 0;
};

/// Whether a hand pose is free of collision, by FCL's boolean test, independent of our distances.
/// Only FCL's boolean collide is used: its signed distance between capsules can be wrong by
/// millimetres and can abort the process. A mesh is tested as its surface and, against a hand part
/// wholly inside it, by one signed distance. Immutable, safe to share between threads.
class HandCertificate {
 public:
  HandCertificate(const HandModel& hand, const std::vector<const Shape*>& shapes);
  ~HandCertificate();
  HandCertificate(HandCertificate&&) noexcept;

  /// @param X_WB  one pose per shape, the object first. Contacting distal links are tested against
  /// the object with their radius less the touch's depth.
  /// @return all collisions, or only the first.
  std::vector<HandCollision> FindCollisions(const HandConfiguration& configuration,
                                            const std::vector<RigidTransform>& X_WB,
                                            const TouchRule& touch, bool first_only = false) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace pregrasp
