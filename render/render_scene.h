#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
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
  kOutline,  ///< hardly filled, its sharp edges and silhouette: one of many alternatives
};

/// One mesh placed in the world. Meshes are shared, never change once they are here, and are cached
/// on the GPU side for as long as they live.
struct RenderBody {
  std::shared_ptr<const TriangleMesh> mesh;
  RigidTransform X_WB = RigidTransform::Identity();
  Rgba color;
  float roughness = 0.6F, metallic = 0.0F;
  Shading shading = Shading::kSolid;
  bool smooth = true;  ///< smooth normals across edges flatter than 40 degrees
  bool edges = false;  ///< draw every edge of the mesh, triangulation included
  /// One colour a triangle in place of `color`, or none; opacity stays that of `color`.
  std::vector<Rgba> face_colors;
};

/// A shaft with a head from `p_W` along `v_W` (metres in the picture).
struct RenderArrow {
  Vector3 p_W = Vector3::Zero(), v_W = Vector3::UnitZ();
  float radius = 0.002F;
  Rgba color;
};

/// A friction cone: apex, axis (its length is the cone's height), half angle [rad]. Translucent:
/// 0.3 opaque at most, whatever `color` asks for; its rim is drawn stronger.
struct RenderCone {
  Vector3 p_W = Vector3::Zero(), axis_W = Vector3::UnitZ();
  float half_angle = 0.6F;
  Rgba color;
};

/// A small ball, lit but without a shadow.
struct RenderPoint {
  Vector3 p_W = Vector3::Zero();
  float radius = 0.003F;
  Rgba color;
};

struct RenderLine {
  std::vector<Vector3> p_W;
  Rgba color;
  float width_px = 1.5F;  ///< in a picture 720 pixels high; scales with the height
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
  double fov_deg = 35.0;  ///< vertical, 1 to 120
};

/// The text of a picture: a card at the top left, a bar along the bottom.
struct RenderCaption {
  std::string title;
  /// A line with a tab is a row of a table ("score\t0.87 N"), values aligned and in monospace; one
  /// with two blanks side by side is set in monospace as it stands; any other is wrapped as prose.
  std::vector<std::string> lines;
  std::string footer;
  double progress = -1.0;  ///< 0 to 1 draws a progress line over the footer; negative draws none
};

/// What colours mean, at the lower right: a scale, swatches, or both.
struct RenderLegend {
  std::string title;
  std::vector<Rgba> scale;                             ///< colours at even steps, left to right
  std::vector<std::pair<double, std::string>> ticks;   ///< texts at 0 (left) to 1 along the scale
  std::vector<std::pair<Rgba, std::string>> swatches;  ///< one a line
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
  RenderLegend legend;
  /// Towards the light; unset takes one from above the camera's left shoulder, so that shadows fall
  /// to the right. A film with a moving camera should set it.
  std::optional<Vector3> to_light_W;
  Vector3 up_W = Vector3::UnitZ();  ///< upwards in the picture, and the floor's normal; unit length
  bool ground = true;  ///< a floor with a grid, its spacing told in the picture's corner
  /// Its height along `up_W`; unset takes the lowest point of the solid bodies.
  std::optional<double> ground_z;
  bool axes = true;                       ///< a frame's axes at the origin: x red, y green, z blue
  Matrix3 R_WAxes = Matrix3::Identity();  ///< that frame: the world's own
  bool fixed_corners = false;  ///< card and legend stay in theirs whatever they hide: in a film
  double font_scale = 1.0;     ///< of all type
};

}  // namespace pregrasp
