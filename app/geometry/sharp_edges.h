#pragma once

#include <vector>

#include "app/scene/shape.h"

namespace pregrasp {

/// A point where faces of a shape meet at a convex edge or corner, and the fan of directions that
/// a sphere may touch it from: those between the faces' normals.
struct EdgePoint {
  Vector3 p_B = Vector3::Zero();
  /// Outward unit normals of the faces, in order around the point: two at an edge, whose fan is the
  /// arc between them; three or more at a corner, whose fan is the spherical polygon.
  std::vector<Vector3> nhats_B;

  bool corner() const { return nhats_B.size() > 2; }
};

/// Points along all convex edges of a loaded shape whose faces meet at more than `least_angle`
/// (0 is flat) [rad], ends included, in frame B: no farther apart than `spacing` [m] and, along
/// rims, than 5 degrees of turn. Then the corners where such edges meet. What a union's other parts
/// hide is not left out. The same for the same shape.
std::vector<EdgePoint> FindEdgePoints(const Shape& shape, double spacing, double least_angle);

}  // namespace pregrasp
