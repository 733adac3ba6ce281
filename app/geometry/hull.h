#pragma once

#include <vector>

#include "app/scene/shape.h"

namespace pregrasp {

/// Convex hull of `points` (#points x 3), closed and outward (qhull). @throws InputError when they
/// lie in a plane.
TriangleMesh CalcConvexHull(const MatrixX3& points);

/// Convex pieces whose union stands for `shape` in contact simulation: the shape itself where it is
/// convex, one piece per part of a union, an approximate decomposition of a mesh that is not
/// convex.
struct ConvexPiece {
  Shape shape;  ///< Box, Cylinder, Capsule, Sphere, or Mesh holding a convex hull
  RigidTransform X_BP = RigidTransform::Identity();
};
std::vector<ConvexPiece> DecomposeConvex(const Shape& shape);

}  // namespace pregrasp
