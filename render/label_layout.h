#pragma once

#include <optional>
#include <vector>

#include "app/core/math.h"
#include "render/canvas.h"

namespace pregrasp {

/// A label to be placed: the pixel it speaks of, and the size of its box [pixels].
struct LabelRequest {
  Vector2 anchor = Vector2::Zero();
  Vector2 size = Vector2::Zero();
};

/// Where labels may go.
struct LabelArea {
  Rect picture;                              ///< boxes stay inside
  std::vector<Rect> obstacles;               ///< and clear of these
  std::vector<std::vector<Vector2>> shapes;  ///< convex outlines better not covered
  double scale = 1.0;                        ///< of gaps and distances
};

/// Places each label near its anchor so that no box overlaps another box, an obstacle, or any
/// label's anchor, and leader lines cross as little as is found by a local search. A label for
/// which there is no such place gets none. A pure function: the same requests give the same places.
std::vector<std::optional<Rect>> LayOutLabels(const std::vector<LabelRequest>& requests,
                                              const LabelArea& area);

/// How much of convex outlines a rectangle hides: the sum of each one's share, by an even grid of
/// points, so that a small thing counts as much as a large one.
double CalcHiddenShares(const Rect& rect, const std::vector<std::vector<Vector2>>& outlines);

/// The point of the box from which the leader to `anchor` starts.
Vector2 LeaderStart(const Rect& box, const Vector2& anchor);

}  // namespace pregrasp
