#pragma once

#include <algorithm>
#include <cmath>

#include "app/dynamics/convex.h"

namespace pregrasp {

/// Index of the vertex farthest along d_P (in the piece's frame).
inline int FindSupportVertex(const Polytope& polytope, const Vector3& d_P) {
  int best = 0;
  double best_height = polytope.vertices[0].dot(d_P);
  for (int i = 1; i < static_cast<int>(polytope.vertices.size()); ++i) {
    const double height = polytope.vertices[i].dot(d_P);
    if (height > best_height) {
      best_height = height;
      best = i;
    }
  }
  return best;
}

/// The point of the piece's core farthest along d_W, in W. The core of a capsule is its axis; other
/// pieces are their own core.
inline Vector3 CalcSupport(const PlacedConvex& placed, const Vector3& d_W) {
  const Convex& convex = *placed.convex;
  const Vector3 d = placed.R_WP.transpose() * d_W;
  Vector3 p = Vector3::Zero();
  switch (convex.kind) {
    case ConvexKind::kBox:
      for (int i = 0; i < 3; ++i) p[i] = std::copysign(convex.half[i], d[i]);
      break;
    case ConvexKind::kPolytope:
      p = convex.polytope->vertices[FindSupportVertex(*convex.polytope, d)];
      break;
    case ConvexKind::kCylinder: {
      const double radial = std::hypot(d.x(), d.y());
      const double scale = radial > 1e-12 * std::abs(d.z()) ? convex.radius / radial : 0.0;
      p = Vector3(scale * d.x(), scale * d.y(), std::copysign(convex.half_height, d.z()));
      break;
    }
    case ConvexKind::kCapsule:
      p = Vector3(0.0, 0.0, std::copysign(convex.half_height, d.z()));
      break;
  }
  return placed.p_WP + placed.R_WP * p;
}

/// How far a piece reaches beyond its core in every direction [m].
inline double CoreRadius(const Convex& convex) {
  return convex.kind == ConvexKind::kCapsule ? convex.radius : 0.0;
}

/// Gap between A and B seen along nhat_W (from A to B); the shapes are apart if it is positive for
/// any direction.
inline double CalcSeparation(const PlacedConvex& a, const PlacedConvex& b, const Vector3& nhat_W) {
  return nhat_W.dot(CalcSupport(b, -nhat_W) - CalcSupport(a, nhat_W)) - CoreRadius(*a.convex) -
         CoreRadius(*b.convex);
}

}  // namespace pregrasp
