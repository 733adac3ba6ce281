#pragma once

#include <optional>

#include "app/scene/shape.h"

namespace pregrasp {

/// The axis about which a mesh is nearly a surface of revolution.
struct Revolution {
  Vector3 p_B = Vector3::Zero();    ///< a point of the axis
  Vector3 axis = Vector3::UnitZ();  ///< unit length
  Vector3 towards =
      Vector3::UnitX();  ///< across the axis: to what spoils the symmetry, as a handle
  int sides = 0;  ///< of the polygon that stands for a circle; 0 where corners are not aligned

  /// The rotation by `angle` [rad] about the axis' direction.
  Matrix3 Turn(double angle) const { return Eigen::AngleAxisd(angle, axis).toRotationMatrix(); }
};

/// Looks for such an axis: the line that the normals of the surface meet. The rotation's velocity
/// field has to lie in the surface everywhere, which is a least-squares problem in its line
/// coordinates (Pottmann and Randrup 1998, "Rotational and helical surface approximation for
/// reverse engineering"), solved with weights that fall with the residual, so that a handle does
/// not tilt the axis. Nothing where less than `share` of the surface that faces away from the axis
/// or towards it agrees, or the axis passes outside the mesh's bounding box.
std::optional<Revolution> FindRevolution(const TriangleMesh& mesh, double share = 0.75);

}  // namespace pregrasp
