#pragma once

#include <array>
#include <vector>

#include "app/core/math.h"
#include "render/camera.h"

namespace pregrasp {

inline constexpr int kShadowLayers = 2;  ///< around the camera's target, and all that is in view

/// Views from the light that cover what a picture needs. They are oblique: the map lies in the
/// horizontal plane and points are moved onto it along the light. A table or floor then has one
/// depth all over, so that its filters need no slope and thin things that lie on it keep their
/// shadows.
struct ShadowFit {
  struct Layer {
    /// World to the shadow map: x and y in [0, 1] across it, z from 0 (nearest the light) to 1.
    Eigen::Matrix4d map_from_world = Eigen::Matrix4d::Identity();
    double width = 1.0;  ///< of the square it covers [m]
    double depth = 1.0;  ///< that z spans, measured along the light [m]
    bool needed = true;  ///< false if the layer before holds all that casts shadows
  };
  Vector3 x_W = Vector3::UnitX(), y_W = Vector3::UnitY();  ///< the map's axes
  std::array<Layer, kShadowLayers> layers;
};

/// Above the camera's left shoulder, 50 degrees over the horizon.
Vector3 DefaultLightDirection(const CameraView& view);

/// @param to_light_W  unit direction towards the light. Near or below the horizon the map is put
///                    across the light instead.
/// @param casters_W   boxes around what casts shadows; what lies outside them all needs no map.
ShadowFit FitShadow(const CameraView& view, const Vector3& to_light_W,
                    const std::vector<Eigen::AlignedBox3d>& casters_W);

}  // namespace pregrasp
