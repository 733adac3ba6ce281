#include "render/light.h"

#include <algorithm>
#include <cmath>

namespace pregrasp {
namespace {

constexpr double kElevation = 50.0 * kPi / 180.0;
constexpr double kAzimuth = 35.0 * kPi / 180.0;  // from the camera's side towards its left
constexpr double kLowest = 0.25;  // sine of the elevation that still allows obliqueness
constexpr double kFar = 8.0;      // of the view that gets shadows, target distances

// World to (x across the map, y across it, depth along the light), all in metres.
Matrix3 MapAxes(const Vector3& x_W, const Vector3& y_W, const Vector3& to_light_W) {
  const Vector3 m = x_W.cross(y_W);
  const double ml = m.dot(to_light_W);
  Matrix3 A;
  A.row(0) = x_W - x_W.dot(to_light_W) / ml * m;
  A.row(1) = y_W - y_W.dot(to_light_W) / ml * m;
  A.row(2) = -m / ml;
  return A;
}

Eigen::AlignedBox3d Mapped(const Eigen::AlignedBox3d& box_W, const Matrix3& A) {
  Eigen::AlignedBox3d box;
  for (int corner = 0; corner < 8; ++corner) {
    box.extend(A * box_W.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
  }
  return box;
}

// What the camera sees from just before it to kFar target distances.
Eigen::AlignedBox3d ViewBounds(const CameraView& view, const Matrix3& A) {
  Eigen::AlignedBox3d box;
  for (const double depth : {0.02 * view.target_distance, kFar * view.target_distance}) {
    for (const double x : {-1.0, 1.0}) {
      for (const double y : {-1.0, 1.0}) {
        const Vector3 ray(x * view.tan_half_fov * view.aspect(), y * view.tan_half_fov, -1.0);
        box.extend(A * (view.p_WCam + view.R_WCam * (depth * ray)));
      }
    }
  }
  return box;
}

// What lies within half the picture's diagonal of the target.
Eigen::AlignedBox3d TargetBounds(const CameraView& view, const Matrix3& A) {
  const double radius = 0.5 * view.view_height() * std::hypot(1.0, view.aspect());
  const Vector3 center = A * (view.p_WCam + view.target_distance * view.forward());
  const Vector3 reach = radius * A.rowwise().norm();
  return {center - reach, center + reach};
}

// Only what is across the light limits a layer; along it, all casters count.
ShadowFit::Layer MakeLayer(const Eigen::AlignedBox3d& wanted, const Eigen::AlignedBox3d& casters,
                           const Matrix3& A) {
  Eigen::AlignedBox3d column = wanted;
  column.min().z() = casters.min().z();
  column.max().z() = casters.max().z();
  Eigen::AlignedBox3d box = column.intersection(casters);
  if (box.isEmpty()) box = casters;
  ShadowFit::Layer layer;
  // A border wide enough that penumbrae, too, lie well on the map.
  layer.width = std::max(1.16 * std::max(box.sizes().x(), box.sizes().y()), 1e-3);
  const double near = casters.min().z() - 0.01 * layer.width;
  layer.depth = casters.max().z() - near + 0.01 * layer.width;
  layer.map_from_world.topLeftCorner<2, 3>() = A.topRows<2>() / layer.width;
  layer.map_from_world.block<1, 3>(2, 0) = A.row(2) / layer.depth;
  layer.map_from_world.topRightCorner<3, 1>() << 0.5 - box.center().x() / layer.width,
      0.5 - box.center().y() / layer.width, -near / layer.depth;
  return layer;
}

}  // namespace

Vector3 DefaultLightDirection(const CameraView& view) {
  // Seen from straight above there is no horizontal view direction: take the picture's upright.
  Vector3 back = view.R_WCam.col(2);
  back.z() = 0.0;
  if (back.norm() < 0.05) back = -view.R_WCam.col(1);
  back.z() = 0.0;
  back.normalize();
  const Vector3 left = -view.R_WCam.col(0);
  const Vector3 level = std::cos(kAzimuth) * back + std::sin(kAzimuth) * left;
  return std::cos(kElevation) * level + std::sin(kElevation) * Vector3::UnitZ();
}

ShadowFit FitShadow(const CameraView& view, const Vector3& to_light_W,
                    const std::vector<Eigen::AlignedBox3d>& casters_W) {
  ShadowFit fit;
  if (to_light_W.z() > kLowest) {
    fit.x_W = view.R_WCam.col(0);  // horizontal, as the camera never rolls
    fit.y_W = Vector3::UnitZ().cross(fit.x_W);
  } else {
    const Matrix3 R = FrameFromNormal(to_light_W);
    fit.x_W = R.col(0);
    fit.y_W = R.col(1);
  }
  const Matrix3 A = MapAxes(fit.x_W, fit.y_W, to_light_W);
  Eigen::AlignedBox3d casters;
  for (const auto& box : casters_W) casters.extend(Mapped(box, A));
  if (casters.isEmpty()) casters.extend(Vector3(Vector3::Zero()));
  fit.layers[0] = MakeLayer(TargetBounds(view, A), casters, A);
  fit.layers[1] = MakeLayer(ViewBounds(view, A), casters, A);
  const auto box = TargetBounds(view, A);
  fit.layers[1].needed = (casters.min().head<2>().array() < box.min().head<2>().array()).any() ||
                         (casters.max().head<2>().array() > box.max().head<2>().array()).any();
  return fit;
}

}  // namespace pregrasp
