#pragma once

#include "app/scene/shape.h"

namespace pregrasp {

using AlignedBox = Eigen::AlignedBox3d;

/// The smallest axis-aligned box around a loaded shape, in its own frame B, or in frame A when
/// placed there by X_AB. Exact for every kind (a rotated cylinder or capsule too).
AlignedBox CalcBounds(const Shape& shape, const RigidTransform& X_AB = RigidTransform::Identity());

}  // namespace pregrasp
