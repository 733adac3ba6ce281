#pragma once

#include <vector>

#include "app/core/math.h"
#include "app/dynamics/manifold.h"

namespace pregrasp {

/// Mean distance of the points of an area from its centroid [m]; of a line from its middle, if the
/// points bound no area.
/// @param points  whose convex hull the area is [m].
double CalcMeanDistance(std::vector<Vector2> points);

/// By how much the points of a contact are to be nearer to their centre for their friction to
/// resist turning on the spot like even pressure over the patch that they stand for: the patch's
/// mean distance from its centre over theirs. A half for a line, 0.54 for a square, two thirds for
/// a disc. The patch is the hull of those of the contact's points that touch (a face's, where some
/// are left out); a disc that touches all round is a disc.
/// @returns 1 if fewer than two points touch.
double CalcSupportSpread(const Manifold& manifold);

}  // namespace pregrasp
