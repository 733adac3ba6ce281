#pragma once

#include <optional>

#include "app/core/math.h"
#include "render/render_scene.h"

namespace pregrasp {

/// A camera made ready for a picture of some size. Up is +z, or +y for a camera that looks straight
/// up or down. Camera axes: x right, y up, z towards the viewer.
struct CameraView {
  Vector3 p_WCam = Vector3::Zero();
  Matrix3 R_WCam = Matrix3::Identity();
  double tan_half_fov = 0.3;     ///< vertical
  double target_distance = 1.0;  ///< [m]
  int width = 0, height = 0;     ///< [pixels]

  double aspect() const { return static_cast<double>(width) / height; }
  Vector3 forward() const { return -R_WCam.col(2); }
  /// Height of what the picture shows at the target's distance [m].
  double view_height() const { return 2.0 * target_distance * tan_half_fov; }
  /// Where a world point falls, in pixels from the top left; nothing if it is behind the camera.
  std::optional<Vector2> Project(const Vector3& p_W) const;
};

/// The camera's axes (columns, in the world) for a view along -`back_W` (unit length).
Matrix3 CameraAxes(const Vector3& back_W);

/// @throws InputError for a camera at its target, a field of view outside 1 to 120 degrees, or
///         numbers that are not finite.
CameraView MakeCameraView(const RenderCamera& camera, int width, int height);

}  // namespace pregrasp
