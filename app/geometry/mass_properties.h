#pragma once

#include "app/scene/scene.h"

namespace pregrasp {

/// Uniform-density mass properties of `shape` (loaded): exact for primitives and meshes; a union
/// counts overlapping volume once. What overlaps is integrated over cells that are split where they
/// cross a surface, down to 1/64 of the overlap's size: exact for boxes along the axes and where
/// parts do not overlap, else to about 1e-3 of the overlap.
MassProperties CalcMassProperties(const Shape& shape, double mass);

/// Volume [m^3] of a loaded shape, computed in the same way.
double CalcVolume(const Shape& shape);

}  // namespace pregrasp
