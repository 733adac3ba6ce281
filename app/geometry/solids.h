#pragma once

#include <vector>

#include "app/scene/shape.h"

namespace pregrasp {

/// Turns each component of a mesh outward, or inward where it is a cavity: where it lies within an
/// odd number of solids, of which those whose surfaces meet count as one. Then takes apart what
/// touches or overlaps: a solid whose surface meets that of another is a mesh of its own, with the
/// cavities in it; all others are one mesh, the last. One mesh where no surfaces meet. The union of
/// the meshes is what the file means.
/// @param mesh  closed, its components consistently oriented, pinched vertices split.
std::vector<TriangleMesh> SeparateSolids(const TriangleMesh& mesh);

}  // namespace pregrasp
