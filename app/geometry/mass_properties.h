#pragma once

#include "app/scene/scene.h"

namespace pregrasp {

/// Uniform-density mass properties of `shape` (loaded): exact for primitives and meshes; a union
/// counts overlapping volume once (its parts are integrated on a fine grid when they overlap,
/// exactly otherwise).
MassProperties CalcMassProperties(const Shape& shape, double mass);

}  // namespace pregrasp
