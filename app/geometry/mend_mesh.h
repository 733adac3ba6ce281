#pragma once

#include <string>

#include "app/scene/shape.h"

namespace pregrasp {

/// What MendMesh did.
struct Mending {
  int merged_corners = 0;  ///< that lay beside each other without being one
  int dropped_faces = 0;   ///< with the corners of an earlier one, turned round or not
  int closed_holes = 0;
  double largest_hole = 0.0;  ///< of those, the largest extent along an axis [m]

  /// "2 faces given twice left out; 3 holes closed, the largest 1.2 mm across"; empty if nothing
  /// was done.
  std::string Text() const;
};

/// Holes up to this share of the mesh's diagonal across are closed: what a scan or an export lost,
/// not an opening.
constexpr double kTinyHole = 0.05;

/// Mends what can be mended without guessing at a shape: merges corners of open edges that lie
/// within 1e-4 of the mesh's diagonal, drops repeated faces, and closes tiny holes by a fan of
/// triangles around the middle of their rim. A rim that touches itself stays open.
/// @param mesh  welded (WeldVertices).
Mending MendMesh(TriangleMesh& mesh);

}  // namespace pregrasp
