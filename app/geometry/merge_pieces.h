#pragma once

#include <vector>

#include "app/geometry/piece.h"

namespace pregrasp {

/// Joins two pieces again and again, those first whose joint hull reaches least outside, as long as
/// it reaches no farther than `limit` [m] or there are more than `max_pieces`.
void MergePieces(const PieceMaker& maker, double limit, int max_pieces, std::vector<Piece>& pieces);

}  // namespace pregrasp
