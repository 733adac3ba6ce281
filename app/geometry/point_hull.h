#pragma once

#include "app/geometry/cloud_planes.h"
#include "app/geometry/mesh_distance.h"
#include "app/geometry/point_index.h"

namespace pregrasp {

/// The convex hull of a cloud, beyond which its surface does not reach: where chance left a corner
/// bare, the planes around it would.
class PointHull {
 public:
  /// @param cloud  with outward normals, not all in a plane.
  explicit PointHull(const SampledCloud& cloud);

  /// Moves vertices that stick out back to the hull, and a little more or less: across an edge the
  /// hull cuts off what lies between the points on either side, so that the less normals there
  /// point the way that a vertex sticks out, the farther it may, up to 0.4 spacings.
  void PullIn(TriangleMesh& mesh) const;

 private:
  MeshDistance distance_;
  PointIndex index_;
  MatrixX3 N_;
  double spacing_;
};

}  // namespace pregrasp
