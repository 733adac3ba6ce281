#pragma once

#include <array>
#include <utility>
#include <vector>

#include "app/geometry/mesh_distance.h"

namespace pregrasp {

/// The distance to a mesh on a coarse grid. Distance changes by at most the way between two points,
/// so that the nearest node gives bounds, which often answer a query without the mesh.
class DistanceBounds {
 public:
  /// @param distance  must outlive this.
  explicit DistanceBounds(const MeshDistance& distance);

  /// Exact where it is near the surface, else within a tenth [m].
  double CalcRoughly(const Vector3& p) const;

  /// The larger of the distance and `floor` [m].
  double CalcAbove(const Vector3& p, double floor) const;

 private:
  static constexpr int kResolution = 32;

  Vector3 Node(int x, int y, int z) const {
    return distance_.bounds().min() + cell_ * Vector3(x, y, z);
  }

  // The value of the node nearest to p, and how far p is from it.
  std::pair<double, double> Nearest(const Vector3& p) const;

  const MeshDistance& distance_;
  double cell_ = 1.0;
  std::array<int, 3> count_{};
  std::vector<double> values_;
};

}  // namespace pregrasp
