#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "app/geometry/mesh_distance.h"

namespace pregrasp {

using Triangle = std::array<Vector3, 3>;

/// Points below a plane have a negative height.
struct Plane {
  Vector3 nhat = Vector3::UnitZ();
  double offset = 0.0;  ///< nhat . p of the plane's points [m]

  double Height(const Vector3& p) const { return nhat.dot(p) - offset; }
  Plane Turned() const { return {-nhat, -offset}; }
};

/// A solid's part in a convex cell: the triangles of its surface there, and the planes the cell
/// lies below. The cut faces themselves are not kept; the part's hull needs only the triangles and
/// the cell's corners inside the solid.
struct SolidPart {
  std::vector<Triangle> surface;
  std::vector<Plane> cell;
};

SolidPart MakeSolidPart(const TriangleMesh& mesh);

/// The part below `plane`. Heights within `snap` [m] count as on the plane; a triangle in it goes
/// to the side on which its solid is.
SolidPart CutBelow(const SolidPart& part, const Plane& plane, double snap);

/// Adds the points that span the part's hull, and more, of each `stride`-th triangle. `distance` is
/// the whole solid's.
void AppendHullPoints(const SolidPart& part, const MeshDistance& distance, std::size_t stride,
                      std::vector<Vector3>& points);

}  // namespace pregrasp
