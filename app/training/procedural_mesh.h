#pragma once

#include <vector>

#include "app/core/math.h"
#include "app/scene/shape.h"

namespace pregrasp {

/// One closed curve of a skinned surface: its points, counter-clockwise seen from above.
using Ring = std::vector<Vector3>;

/// The closed surface through `rings` (at least 2, of equally many points), outward where they go
/// up on the outside; the first and the last ring are closed by flat fans about their mean point.
/// Going on downwards on the inside makes a vessel.
TriangleMesh SkinRings(const std::vector<Ring>& rings);

/// The surface of revolution about z of `profile`, (radius, z) pairs with radii above 0 [m].
TriangleMesh Lathe(const std::vector<Vector2>& profile, int segments = 32);

/// A rectangle of full size x by y with corners of `radius`, level at height z [m].
Ring RoundedRectangle(double x, double y, double radius, double z);

/// A Mesh shape that names no file.
Mesh MakeMeshShape(TriangleMesh mesh);

}  // namespace pregrasp
