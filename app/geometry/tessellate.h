#pragma once

#include "app/scene/shape.h"

namespace pregrasp {

/// A closed triangle mesh of a loaded shape, for pictures, clouds and meshes: `segments` per full
/// turn. A union gives its parts side by side, inner surfaces included.
TriangleMesh Tessellate(const Shape& shape, int segments = 48);

}  // namespace pregrasp
