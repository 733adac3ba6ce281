#pragma once

#include <vector>

#include "app/geometry/piece.h"
#include "app/geometry/revolution.h"

namespace pregrasp {

/// Pieces of a solid that is nearly one of revolution.
struct Sectors {
  std::vector<Piece> pieces;
  double protrusion = 0.0;  ///< the largest of a sector without handle [m]
};

/// Takes a solid apart that is nearly one of revolution: into equal sectors about its axis, and
/// each of them along cones, as cuts of the profile, which are the same in all sectors. Their
/// number is the one that makes fewest pieces of those that reach at most `limit` [m] outside or,
/// where that takes more than `max_pieces`, the one whose pieces reach least outside. What lies
/// around the axis and is convex stays whole. Pieces that hold more than the profile, such as a
/// handle, may reach farther outside.
Sectors CutIntoSectors(const PieceMaker& maker, const Revolution& revolution, double limit,
                       int max_pieces);

}  // namespace pregrasp
