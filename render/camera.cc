#include "render/camera.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/core/check.h"
#include "app/core/error.h"
#include "app/core/text.h"
#include "render/renderer.h"

namespace pregrasp {
namespace {

constexpr double kBorder = 0.10;           // share of the picture left free on each side
constexpr double kSmallestDistance = 0.1;  // for a focus of a single point [m]

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
    throw InputError("camera", "fov_deg", "1 to 120 degrees", FormatDouble(camera.fov_deg));
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
  // In the camera's axes about the world's origin. A camera at c sees a point x between its left
  // and right planes if |x - c| <= t (c_z - x_z) along x; each side bounds c by the extreme of x -+
  // t z, and the two bounds meet where the camera is as near as it can be. The same along y.
  const MatrixX3 p = focus * R_WCam;
  const double t_y = std::tan(0.5 * DegToRad(fov_deg)) * (1.0 - 2.0 * kBorder);
  const double t[2] = {t_y * aspect, t_y};
  Vector3 c(0.0, 0.0, -std::numeric_limits<double>::infinity());
  for (int axis = 0; axis < 2; ++axis) {
    const double high = (p.col(axis) + t[axis] * p.col(2)).maxCoeff();
    const double low = (p.col(axis) - t[axis] * p.col(2)).minCoeff();
    c[axis] = 0.5 * (high + low);
    c.z() = std::max(c.z(), 0.5 * (high - low) / t[axis]);
  }
  const double front = p.col(2).maxCoeff();
  c.z() = std::max(c.z(), front + kSmallestDistance);
  // With the distance fixed by one axis, the other has room to spare: centre what it shows.
  for (int axis = 0; axis < 2; ++axis) {
    const auto depth = (c.z() - p.col(2).array()).eval();
    const double high = (p.col(axis).array() / depth).maxCoeff();
    const double low = (p.col(axis).array() / depth).minCoeff();
    const double middle = 0.5 * (high + low) * (c.z() - p.col(2).mean());
    const double bound_high = (p.col(axis) + t[axis] * p.col(2)).maxCoeff() - t[axis] * c.z();
    const double bound_low = (p.col(axis) - t[axis] * p.col(2)).minCoeff() + t[axis] * c.z();
    c[axis] = std::clamp(middle, std::min(bound_high, bound_low), std::max(bound_high, bound_low));
  }
  RenderCamera camera;
  camera.fov_deg = fov_deg;
  camera.p_WCam = R_WCam * c;
  camera.p_WTarget = R_WCam * Vector3(c.x(), c.y(), p.col(2).mean());
  return camera;
}

}  // namespace pregrasp
