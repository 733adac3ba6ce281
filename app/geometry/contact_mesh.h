#pragma once

#include "app/scene/shape.h"

namespace pregrasp {

struct ContactMeshConfig {
  /// Number of triangles of the result, exact; even, at least 12. The paper uses 30 to 50.
  int triangles = 40;
  /// A shape whose volume is at least this share of its hull's is meshed from its hull.
  double convex_share = 0.97;
};

/// The simplified mesh whose triangles are the planner's contact regions (paper, section "Contact
/// state graph"): the hull of a near-convex shape and of one whose handles need more triangles,
/// else the surface itself, large faces subdivided first, then reduced by quadric edge collapse
/// with optimal placement (Garland and Heckbert 1997) under the link condition and a normal-flip
/// test, with a term that keeps triangles even. Deterministic; closed and two-manifold; exactly
/// `triangles` faces. Limit: the two sides of a wall thinner than the triangles stand off a curve
/// (some 5 mm for a cup of 40 triangles) may cross; normals are therefore taken from the true
/// shape.
TriangleMesh BuildContactMesh(const Shape& shape, const ContactMeshConfig& config);

}  // namespace pregrasp
