#include "render/camera.h"

#include <algorithm>
#include <cmath>

#include "app/core/check.h"
#include "app/core/error.h"
#include "app/core/text.h"
#include "render/renderer.h"

namespace pregrasp {
namespace {

// Shares of the picture left free around a focus; the card and the footer lie at top and bottom.
constexpr double kSideBorder = 0.10, kTopBorder = 0.15, kBottomBorder = 0.11;
constexpr double kSmallestDistance = 2e-3;  // for a focus of a single point [m]

}  // namespace

Matrix3 CameraAxes(const Vector3& back_W) {
  const Vector3 up =
      std::hypot(back_W.x(), back_W.y()) > 1e-3 ? Vector3::UnitZ() : Vector3::UnitY();
  Matrix3 R_WCam;
  R_WCam.col(2) = back_W;
  R_WCam.col(0) = up.cross(back_W).normalized();
  R_WCam.col(1) = back_W.cross(R_WCam.col(0));
  return R_WCam;
}

CameraView MakeCameraView(const RenderCamera& camera, int width, int height) {
  if (!camera.p_WCam.allFinite() || !camera.p_WTarget.allFinite()) {
    throw InputError("camera", "p_WCam, p_WTarget", "finite numbers", "nan or inf");
  }
  if (!(camera.fov_deg >= 1.0 && camera.fov_deg <= 120.0)) {
    throw InputError("camera", "fov_deg", "1 to 120 deg", FormatDouble(camera.fov_deg));
  }
  const Vector3 back = camera.p_WCam - camera.p_WTarget;
  const double distance = back.norm();
  if (!(distance >= 1e-4 && distance <= 1e4)) {
    throw InputError("camera", "p_WCam", "a place 0.1 mm to 10 km from p_WTarget",
                     FormatDouble(distance) + " m");
  }
  CameraView view;
  view.p_WCam = camera.p_WCam;
  view.R_WCam = CameraAxes(back / distance);
  view.tan_half_fov = std::tan(0.5 * DegToRad(camera.fov_deg));
  view.target_distance = distance;
  view.width = width;
  view.height = height;
  return view;
}

std::optional<Vector2> CameraView::Project(const Vector3& p_W) const {
  const Vector3 p = R_WCam.transpose() * (p_W - p_WCam);
  if (p.z() > -1e-3 * target_distance) return std::nullopt;
  const double scale = 0.5 * height / (tan_half_fov * -p.z());
  return Vector2(0.5 * width + scale * p.x(), 0.5 * height - scale * p.y());
}

RenderCamera FrameCamera(const MatrixX3& focus, const Vector3& dir_W, double aspect,
                         double fov_deg) {
  PREGRASP_CHECK(focus.rows() > 0 && focus.allFinite() && aspect > 0.0, focus.rows(), aspect);
  PREGRASP_CHECK(dir_W.allFinite() && dir_W.norm() > 1e-9, dir_W.transpose());
  const Vector3 back = dir_W.normalized();
  const Matrix3 R_WCam = CameraAxes(back);
  // In the camera's axes about the world's origin. A camera at c has a point x left of its right
  // border if x_x - c_x <= t (c_z - x_z), and likewise on each side: the extremes of x +- t z bound
  // c, and the two bounds of an axis meet where the camera is as near as it can be.
  const MatrixX3 p = focus * R_WCam;
  const double tan_y = std::tan(0.5 * DegToRad(fov_deg)), tan_x = tan_y * aspect;
  const double t_high[2] = {tan_x * (1.0 - 2.0 * kSideBorder), tan_y * (1.0 - 2.0 * kTopBorder)};
  const double t_low[2] = {tan_x * (1.0 - 2.0 * kSideBorder), tan_y * (1.0 - 2.0 * kBottomBorder)};
  Vector2 high, low;
  Vector3 c(0.0, 0.0, p.col(2).maxCoeff() + kSmallestDistance);
  for (int axis = 0; axis < 2; ++axis) {
    high[axis] = (p.col(axis) + t_high[axis] * p.col(2)).maxCoeff();
    low[axis] = (p.col(axis) - t_low[axis] * p.col(2)).minCoeff();
    c.z() = std::max(c.z(), (high[axis] - low[axis]) / (t_high[axis] + t_low[axis]));
  }
  // What room the distance leaves on an axis is shared between its two sides.
  for (int axis = 0; axis < 2; ++axis) {
    c[axis] = 0.5 * (high[axis] - t_high[axis] * c.z() + low[axis] + t_low[axis] * c.z());
  }
  RenderCamera camera;
  camera.fov_deg = fov_deg;
  camera.p_WCam = R_WCam * c;
  camera.p_WTarget = R_WCam * Vector3(c.x(), c.y(), p.col(2).mean());
  return camera;
}

}  // namespace pregrasp
