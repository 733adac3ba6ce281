#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/core/math.h"
#include "app/scene/shape.h"

namespace pregrasp {

/// Linear-light colour, 0 to 1, with opacity.
struct Rgba {
  float r = 0.8F, g = 0.8F, b = 0.8F, a = 1.0F;
};

enum class Shading {
  kSolid,    ///< lit, casts and receives shadows
  kGhost,    ///< translucent, unshadowed: another time or an alternative
  kOverlay,  ///< flat colour over everything
};

/// One mesh placed in the world. Meshes are shared and cached on the GPU side by pointer for the
/// renderer's life.
struct RenderBody {
  std::shared_ptr<const TriangleMesh> mesh;
  RigidTransform X_WB = RigidTransform::Identity();
  Rgba color;
  float roughness = 0.6F, metallic = 0.0F;
  Shading shading = Shading::kSolid;
  bool smooth = true;  ///< smooth normals across edges flatter than 40 degrees
  bool edges = false;  ///< draw the mesh's edges
};

/// A shaft with a head from `p_W` along `v_W` (metres in the picture).
struct RenderArrow {
  Vector3 p_W = Vector3::Zero(), v_W = Vector3::UnitZ();
  float radius = 0.002F;
  Rgba color;
};

/// A friction cone, translucent: apex, axis (its length is the cone's height), half angle [rad].
struct RenderCone {
  Vector3 p_W = Vector3::Zero(), axis_W = Vector3::UnitZ();
  float half_angle = 0.6F;
  Rgba color;
};

struct RenderPoint {
  Vector3 p_W = Vector3::Zero();
  float radius = 0.003F;
  Rgba color;
};

struct RenderLine {
  std::vector<Vector3> p_W;
  Rgba color;
  float width_px = 1.5F;
};

/// A text beside a world point with a leader line; labels are moved apart so that none overlap.
struct RenderLabel {
  Vector3 p_W = Vector3::Zero();
  std::string text;
  Rgba color;
};

struct RenderCamera {
  Vector3 p_WCam{0.6, -0.8, 0.6};
  Vector3 p_WTarget = Vector3::Zero();
  double fov_deg = 35.0;
};

/// The text of a picture: a card at the top left, a bar along the bottom.
struct RenderCaption {
  std::string title;
  std::vector<std::string> lines;
  std::string footer;
  double progress = -1.0;  ///< 0 to 1 draws a progress line over the footer; negative draws none
};

/// All that a picture shows. Knows nothing of planning.
struct RenderScene {
  std::vector<RenderBody> bodies;
  std::vector<RenderArrow> arrows;
  std::vector<RenderCone> cones;
  std::vector<RenderPoint> points;
  std::vector<RenderLine> lines;
  std::vector<RenderLabel> labels;
  RenderCamera camera;
  RenderCaption caption;
  double ground_z = 0.0;  ///< height of the ground grid
  bool ground = true;
  bool axes = true;  ///< the world frame's axes at the origin
};

}  // namespace pregrasp
