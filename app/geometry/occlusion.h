#pragma once

#include <vector>

#include "app/geometry/point_cloud.h"
#include "app/geometry/signed_distance.h"

namespace pregrasp {

/// For each cloud point (given in O): true where a fingertip sphere of `radius` [m] that touches
/// the surface there from outside would overlap the environment, that is where the environment's
/// distance at p + radius n is below radius.
std::vector<bool> FindOccluded(const PointCloud& cloud, const RigidTransform& X_WO,
                               const EnvironmentDistance& environment, double radius);

}  // namespace pregrasp
