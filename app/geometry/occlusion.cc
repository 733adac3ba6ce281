#include "app/geometry/occlusion.h"

namespace pregrasp {

std::vector<bool> FindOccluded(const PointCloud& cloud, const RigidTransform& X_WO,
                               const EnvironmentDistance& environment, double radius) {
  constexpr double kTouching = 1e-9;  // [m]; a sphere that just touches is free
  std::vector<bool> occluded(cloud.P.rows());
  for (int i = 0; i < cloud.P.rows(); ++i) {
    const Vector3 centre_O = cloud.P.row(i) + radius * cloud.N.row(i);
    occluded[i] = environment.Calc(X_WO * centre_O).phi < radius - kTouching;
  }
  return occluded;
}

}  // namespace pregrasp
