#pragma once

#include "render/render_scene.h"

namespace pregrasp {

/// The least rotation that takes `up_W` to +z: from the world to a frame U that stands upright, in
/// which everything is drawn. @param up_W  not zero.
Matrix3 UprightRotation(const Vector3& up_W);

RenderCamera Rotated(RenderCamera camera, const Matrix3& R);

/// All of the picture rotated by `R`, its directions and the axes of its world among it.
RenderScene Rotated(RenderScene scene, const Matrix3& R);

}  // namespace pregrasp
