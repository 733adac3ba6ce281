#pragma once

#include "app/scene/shape.h"

namespace pregrasp {

/// Takes apart what meets in an edge: at an edge of four, six, .. triangles, those between which
/// the solid lies stay together, and each group gets vertices of its own. Needs triangles that face
/// outward there.
/// @return false, and nothing changed, where the triangles at an edge do not alternate: some lie on
/// each other, or face the wrong way.
bool SplitCrowdedEdges(TriangleMesh& mesh);

}  // namespace pregrasp
