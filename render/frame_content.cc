#include "render/frame_content.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/core/check.h"
#include "app/core/error.h"
#include "render/mesh_surface.h"
#include "render/palette.h"

namespace pregrasp {
namespace {

constexpr float kConeOpacity = 0.30F;
constexpr double kAxisShare = 0.09;  // length of the world's axes, of the view's height

Instance MakeInstance(const Eigen::Affine3d& X, const Rgba& color) {
  Instance instance{};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      instance.rows[4 * row + column] = static_cast<float>(X.matrix()(row, column));
    }
  }
  const float rgba[4] = {color.r, color.g, color.b, color.a};
  std::copy(rgba, rgba + 4, instance.color);
  instance.first_color = -1.0F;
  return instance;
}

void RequireFinite(bool finite, const char* list, std::size_t i) {
  if (!finite) {
    throw InputError("picture", std::string(list) + "[" + std::to_string(i) + "]", "finite numbers",
                     "nan or inf");
  }
}

bool Finite(const Rgba& c) { return std::isfinite(c.r + c.g + c.b + c.a); }

class Collector {
 public:
  Collector(const RenderScene& scene, const CameraView& view, const AnnotationMeshes& meshes,
            MeshCache& cache)
      : scene_(scene), view_(view), meshes_(meshes), cache_(cache) {}

  FrameContent Collect() {
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) AddBody(i);
    for (std::size_t i = 0; i < scene_.arrows.size(); ++i) {
      const RenderArrow& arrow = scene_.arrows[i];
      RequireFinite(arrow.p_W.allFinite() && arrow.v_W.allFinite() && Finite(arrow.color) &&
                        std::isfinite(arrow.radius),
                    "arrows", i);
      AddArrow(arrow, true);
    }
    if (scene_.axes) AddAxes();
    AddPoints();
    for (std::size_t i = 0; i < scene_.cones.size(); ++i) AddCone(i);
    for (std::size_t i = 0; i < scene_.lines.size(); ++i) {
      const RenderLine& line = scene_.lines[i];
      bool finite = Finite(line.color) && std::isfinite(line.width_px);
      for (const Vector3& p : line.p_W) finite = finite && p.allFinite();
      RequireFinite(finite, "lines", i);
      AddLine(line);
    }
    for (std::size_t i = 0; i < scene_.labels.size(); ++i) {
      RequireFinite(scene_.labels[i].p_W.allFinite() && Finite(scene_.labels[i].color), "labels",
                    i);
    }
    const auto nearer = [](const Draw& a, const Draw& b) { return a.distance < b.distance; };
    const auto farther = [](const Draw& a, const Draw& b) { return a.distance > b.distance; };
    std::stable_sort(content_.solids.begin(), content_.solids.end(), nearer);
    std::stable_sort(content_.ghosts.begin(), content_.ghosts.end(), farther);
    std::stable_sort(content_.cones.begin(), content_.cones.end(), farther);
    return std::move(content_);
  }

 private:
  double DistanceOf(const Vector3& p_W) const { return (p_W - view_.p_WCam).dot(view_.forward()); }

  void AddBody(std::size_t index) {
    const RenderBody& body = scene_.bodies[index];
    RequireFinite(body.X_WB.matrix().allFinite() && Finite(body.color) &&
                      std::isfinite(body.roughness + body.metallic),
                  "bodies", index);
    PREGRASP_CHECK(body.mesh != nullptr, index);
    if (body.mesh->F.rows() == 0) return;
    GpuMesh& mesh = cache_.Get(body.mesh);
    Draw draw;
    draw.surface = &cache_.Surface(mesh, body.smooth);
    draw.closed = mesh.closed;
    draw.first = static_cast<int>(content_.instances.size());
    Instance instance = MakeInstance(Eigen::Affine3d(body.X_WB), body.color);
    instance.roughness = std::clamp(body.roughness, 0.0F, 1.0F);
    instance.metallic = std::clamp(body.metallic, 0.0F, 1.0F);
    draw.outline = body.shading == Shading::kOutline;
    constexpr float kOutlineFilled = 0.07F;
    if (draw.outline) instance.color[3] *= kOutlineFilled;
    if (!body.face_colors.empty()) instance.first_color = AddFaceColors(body, index);
    draw.color = body.color;
    draw.material = {instance.roughness, instance.metallic, instance.first_color, 0.0F};
    const Eigen::Matrix4f X_WB = body.X_WB.matrix().cast<float>();
    std::copy(X_WB.data(), X_WB.data() + 16, draw.X_WB.begin());
    if (body.edges) draw.all_edges = &cache_.Edges(mesh, false);
    if (!body.edges) draw.creases = &cache_.Edges(mesh, true);
    Eigen::AlignedBox3d box_W;
    for (int corner = 0; corner < 8; ++corner) {
      box_W.extend(body.X_WB *
                   mesh.bounds_B.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
    }
    draw.distance = DistanceOf(box_W.center());
    content_.instances.push_back(instance);
    if (body.shading == Shading::kSolid) {
      content_.solids.push_back(draw);
      content_.solid_bounds_W.push_back(box_W);
    } else {
      content_.ghosts.push_back(draw);
    }
  }

  float AddFaceColors(const RenderBody& body, std::size_t index) {
    if (body.face_colors.size() != static_cast<std::size_t>(body.mesh->F.rows())) {
      throw InputError("picture", "bodies[" + std::to_string(index) + "].face_colors",
                       std::to_string(body.mesh->F.rows()) + " colours, one a triangle",
                       std::to_string(body.face_colors.size()));
    }
    const auto first = static_cast<float>(content_.face_colors.size());
    for (const Rgba& c : body.face_colors) {
      RequireFinite(Finite(c), "bodies", index);
      content_.face_colors.push_back({c.r, c.g, c.b, c.a});
    }
    return first;
  }

  // A part of an annotation: lit, but outside the world of shadows.
  Draw AddPart(const std::shared_ptr<const TriangleMesh>& mesh, const Eigen::Affine3d& X,
               const Rgba& color, float roughness) {
    Draw draw;
    GpuMesh& entry = cache_.Get(mesh);
    draw.surface = &cache_.Surface(entry, true);
    draw.closed = entry.closed;
    draw.first = static_cast<int>(content_.instances.size());
    draw.distance = DistanceOf(X.translation());
    draw.color = color;
    Instance instance = MakeInstance(X, color);
    instance.roughness = roughness;
    instance.annotation = 1.0F;
    content_.instances.push_back(instance);
    return draw;
  }

  void AddArrow(const RenderArrow& arrow, bool shines_through) {
    const double length = arrow.v_W.norm();
    if (!(length > 1e-9) || !(arrow.radius > 0.0F)) return;
    // A short arrow keeps its proportions instead of becoming a disc.
    const double radius = std::min<double>(arrow.radius, length / 9.0);
    const double head = 6.0 * radius;
    const Matrix3 R = FrameFromNormal(arrow.v_W / length);
    const auto placed = [&](double from, double to, double r) {
      Eigen::Affine3d X = Eigen::Affine3d::Identity();
      X.linear() = R * Vector3(r, r, to - from).asDiagonal();
      X.translation() = arrow.p_W + from * R.col(2);
      return X;
    };
    for (const Draw& part :
         {AddPart(meshes_.shaft, placed(0.0, length - head, radius), arrow.color, 0.5F),
          AddPart(meshes_.head, placed(length - head, length, 2.5 * radius), arrow.color, 0.5F)}) {
      content_.annotations.push_back(part);
      if (shines_through) content_.arrows.push_back(part);
    }
  }

  void AddAxes() {
    const double length = kAxisShare * view_.view_height();
    const std::array<Rgba, 3> colors = {FromSrgb(0xD64534), FromSrgb(0x3AA346), FromSrgb(0x3567D6)};
    for (int axis = 0; axis < 3; ++axis) {
      RenderArrow arrow;
      arrow.v_W = length * scene_.R_WAxes.col(axis);
      arrow.radius = static_cast<float>(0.03 * length);
      arrow.color = colors[axis];
      AddArrow(arrow, false);
    }
  }

  // Points of one mesh are one draw call.
  void AddPoints() {
    std::vector<std::vector<std::size_t>> by_ball(meshes_.balls.size());
    for (std::size_t i = 0; i < scene_.points.size(); ++i) {
      const RenderPoint& point = scene_.points[i];
      RequireFinite(point.p_W.allFinite() && Finite(point.color) && std::isfinite(point.radius),
                    "points", i);
      const double distance = DistanceOf(point.p_W);
      if (!(point.radius > 0.0F) || distance <= 0.0) continue;
      const double pixels = 0.5 * view_.height * point.radius / (distance * view_.tan_half_fov);
      const std::size_t ball = pixels < 3.0 ? 0 : pixels < 14.0 ? 1 : pixels < 60.0 ? 2 : 3;
      by_ball[ball].push_back(i);
    }
    for (std::size_t ball = 0; ball < by_ball.size(); ++ball) {
      if (by_ball[ball].empty()) continue;
      Draw all;
      for (const std::size_t i : by_ball[ball]) {
        const RenderPoint& point = scene_.points[i];
        Eigen::Affine3d X = Eigen::Affine3d::Identity();
        X.linear() *= point.radius;
        X.translation() = point.p_W;
        const Draw one = AddPart(meshes_.balls[ball], X, point.color, 0.5F);
        if (i == by_ball[ball].front()) all = one;
      }
      all.count = static_cast<int>(by_ball[ball].size());
      content_.annotations.push_back(all);
    }
  }

  void AddCone(std::size_t index) {
    const RenderCone& cone = scene_.cones[index];
    RequireFinite(cone.p_W.allFinite() && cone.axis_W.allFinite() && Finite(cone.color) &&
                      std::isfinite(cone.half_angle),
                  "cones", index);
    const double height = cone.axis_W.norm();
    if (!(height > 1e-9)) return;
    const double radius = height * std::tan(std::clamp<double>(cone.half_angle, 0.01, 1.45));
    const Matrix3 R = FrameFromNormal(cone.axis_W / height);
    Eigen::Affine3d X = Eigen::Affine3d::Identity();
    X.linear() = R * Vector3(radius, radius, height).asDiagonal();
    X.translation() = cone.p_W;
    Rgba color = cone.color;
    color.a = std::min(color.a, kConeOpacity);
    Draw draw = AddPart(meshes_.cone, X, color, 0.5F);
    draw.distance = DistanceOf(cone.p_W + 0.6 * cone.axis_W);
    content_.cones.push_back(draw);
    RenderLine rim;
    rim.color = WithAlpha(cone.color, 2.7F * color.a);
    rim.width_px = 1.2F;
    constexpr int kPieces = 48;
    for (int i = 0; i <= kPieces; ++i) {
      const double angle = 2.0 * kPi * i / kPieces;
      rim.p_W.push_back(X * Vector3(std::cos(angle), std::sin(angle), 1.0));
    }
    AddLine(rim);
  }

  void AddLine(const RenderLine& line) {
    for (std::size_t i = 0; i + 1 < line.p_W.size(); ++i) {
      LinePiece piece{};
      for (int axis = 0; axis < 3; ++axis) {
        piece.p[axis] = static_cast<float>(line.p_W[i][axis]);
        piece.q[axis] = static_cast<float>(line.p_W[i + 1][axis]);
      }
      const float rgba[4] = {line.color.r, line.color.g, line.color.b, line.color.a};
      std::copy(rgba, rgba + 4, piece.color);
      piece.width = line.width_px;
      content_.lines.push_back(piece);
    }
  }

  const RenderScene& scene_;
  const CameraView& view_;
  const AnnotationMeshes& meshes_;
  MeshCache& cache_;
  FrameContent content_;
};

}  // namespace

AnnotationMeshes::AnnotationMeshes()
    : shaft(std::make_shared<TriangleMesh>(UnitCylinder(24))),
      head(std::make_shared<TriangleMesh>(UnitCone(32))),
      cone(std::make_shared<TriangleMesh>(UnitOpenCone(48))) {
  for (int subdivisions = 0; subdivisions < 4; ++subdivisions) {
    balls.push_back(std::make_shared<TriangleMesh>(UnitBall(subdivisions)));
  }
}

FrameContent CollectContent(const RenderScene& scene, const CameraView& view,
                            const AnnotationMeshes& meshes, MeshCache& cache) {
  return Collector(scene, view, meshes, cache).Collect();
}

}  // namespace pregrasp
