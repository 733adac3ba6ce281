#pragma once

#include <array>
#include <span>
#include <vector>

#include "app/core/math.h"

namespace pregrasp {

/// A polygon in space as triangles of its corners, two fewer than these and turned as it is: ears
/// are cut in the plane of its mean normal, so that a hollow corner keeps its hollow. A polygon
/// that crosses itself gives some triangles all the same; fewer than three corners give none.
/// @returns indices into `corners`, quadratic in their number where not all corners are convex.
std::vector<std::array<int, 3>> TriangulatePolygon(std::span<const Vector3> corners);

}  // namespace pregrasp
