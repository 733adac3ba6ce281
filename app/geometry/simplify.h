#pragma once

#include <vector>

#include "app/scene/shape.h"

namespace pregrasp {

/// The plane that a face stands for.
struct FacePlane {
  Vector3 p = Vector3::Zero();
  Vector3 nhat = Vector3::UnitZ();
};

/// Splits edges at their middles, the longest first, until none is longer than `max_edge` [m]. The
/// surface stays as it is.
TriangleMesh SplitLongEdges(const TriangleMesh& mesh, double max_edge);

/// Fewer triangles by edge collapse (Garland and Heckbert 1997, "Surface simplification using
/// quadric error metrics"): an edge becomes the point nearest, by the sum of squares, to the planes
/// of all faces gone into it, so that round bodies shrink little and edges stay sharp; where those
/// planes leave a direction free, it goes to the faces' middle. Edges go in the order of the mean
/// square distance to those planes, plus a millionth of that to the faces' places: one
/// millimetre off the surface counts like a metre along it, which makes triangles even where the
/// surface is flat and changes nothing else. Keeps the surface closed and two-manifold (link
/// condition) and turns no face over. Deterministic.
/// @param mesh    closed and two-manifold; `planes` of its faces, or empty for the faces' own.
/// @param target  number of faces wanted, even. The result has more when its handles or flat folds
///                allow no fewer.
TriangleMesh SimplifyMesh(const TriangleMesh& mesh, const std::vector<FacePlane>& planes,
                          int target);

/// Turns edges between coplanar faces (within `tolerance`, the sine of their angle) so that the
/// smallest angles grow. The surface stays as it is, and so does the number of faces.
void FlipFlatEdges(TriangleMesh& mesh, double tolerance);

}  // namespace pregrasp
