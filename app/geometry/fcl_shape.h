#pragma once

#include <fcl/geometry/collision_geometry.h>

#include <memory>

#include "app/scene/shape.h"

namespace pregrasp {

/// FCL's geometry of a shape that is no union: of a mesh or cloud its surface, of which FCL knows
/// no inside. Its bounds are computed.
std::shared_ptr<fcl::CollisionGeometryd> MakeFclShape(const Shape& leaf);

}  // namespace pregrasp
