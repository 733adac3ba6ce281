#pragma once

#include <array>
#include <cstdint>

#include "app/core/math.h"

namespace pregrasp {

/// Four points of a disc's rim that stand for all of it, as unit vectors in the disc's own axes.
struct RimPoints {
  std::array<Vector2, 4> directions;
  std::array<std::uint32_t, 4> ids;
};

/// @param down       the way in the disc's own axes along which the gap under it shrinks fastest;
///                   its length is the tilt [rad], while that is small.
/// @param down_next  the same at the end of the step, if nothing is in the disc's way.
/// @returns the lowest point; of a disc that rolls round its rim also the lowest at the end of the
/// step; and points that spread over the rest of the rim. A disc that lies flat keeps the same
/// four.
RimPoints ChooseRimPoints(double radius, const Vector2& down, const Vector2& down_next);

}  // namespace pregrasp
