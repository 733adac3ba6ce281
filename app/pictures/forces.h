#pragma once

#include <vector>

#include "app/job/step_facts.h"
#include "app/scene/scene.h"

namespace pregrasp {

/// A contact force on the object, split along the surface's normal.
struct ForceSplit {
  double normal = 0.0;      ///< [N], pressing
  double tangential = 0.0;  ///< [N], along the surface
  double limit = 0.0;       ///< [N], what friction can give at this normal force
};

/// @param q_WO  the object's orientation.
ForceSplit SplitFingerForce(const Scene& scene, const Quaternion& q_WO, const FingerFacts& finger);

/// What one body of the scene does to the object, over all its contact points.
struct SupportForce {
  int body = 0;                   ///< in Scene::bodies
  Vector3 f_W = Vector3::Zero();  ///< sum on the object [N]
  ForceSplit split;               ///< sums of the points' parts
  bool slipping = false;          ///< friction is used up (over 99 %)
};

/// Those that press with more than 1 mN, by body.
std::vector<SupportForce> CalcSupportForces(const Scene& scene,
                                            const std::vector<ContactFacts>& contacts);

}  // namespace pregrasp
