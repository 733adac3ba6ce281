#pragma once

#include <vector>

#include "app/geometry/signed_distance.h"
#include "render/renderer.h"

namespace pregrasp {

/// Where to look at an object from: among views from the sides and above, in an order that prefers
/// a little to the right and above, the first from which the environment hides no more of it than
/// from the best.
/// @param mesh_W  the object's surface in the world. @param up_W  against gravity, unit length.
Vector3 ChooseViewDirection(const TriangleMesh& mesh_W, const EnvironmentDistance& environment,
                            const Vector3& up_W);

/// Whether all points (#points x 3) lie within the picture, at least `border` of its half width and
/// half height from the edge. In a frame in which +z is up.
bool IsInSight(const RenderCamera& camera, const MatrixX3& P_W, double aspect, double border);

/// Of these points (at least one) the outermost in each of 26 directions evenly around (26 x 3).
MatrixX3 FindOutermost(const MatrixX3& P);

/// Corners of the box around the object's points, widened on all sides by `share` of its longest
/// edge, so that the surroundings show and small motions stay in the picture, and along +z by
/// `headroom` [m] more, for fingers and for the card of text (8 x 3).
MatrixX3 FocusAround(const MatrixX3& P_W, double share, double headroom);

}  // namespace pregrasp
