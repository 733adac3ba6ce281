#pragma once

#include "app/dynamics/convex.h"
#include "app/scene/shape.h"

namespace pregrasp {

/// A box's polytope: corner i has +x if bit 0 is set, +y for bit 1, +z for bit 2.
Polytope MakeBoxPolytope(const Vector3& half);

/// The polytope of a closed convex triangle mesh, outward: neighbouring triangles in one plane (but
/// for the rounding of a mesh file) become one face, whose plane supports the whole polytope.
Polytope MakePolytope(const TriangleMesh& hull);

}  // namespace pregrasp
