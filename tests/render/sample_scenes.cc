#include "tests/render/sample_scenes.h"

#include <cmath>

#include "app/core/rng.h"
#include "render/palette.h"
#include "render/renderer.h"

namespace pregrasp {
namespace {

RenderBody Placed(TriangleMesh mesh, const Vector3& p, const Rgba& color, float roughness = 0.55F) {
  RenderBody body;
  body.mesh = std::make_shared<TriangleMesh>(std::move(mesh));
  body.X_WB = MakeTransform(Matrix3(Matrix3::Identity()), p);
  return WithLook(std::move(body), color, roughness);
}

}  // namespace

TriangleMesh BoxMesh(const Vector3& size) {
  TriangleMesh mesh;
  mesh.V.resize(8, 3);
  for (int i = 0; i < 8; ++i) {
    mesh.V.row(i) << ((i & 1) - 0.5) * size.x(), (((i >> 1) & 1) - 0.5) * size.y(),
        ((i >> 2) - 0.5) * size.z();
  }
  mesh.F.resize(12, 3);
  mesh.F << 0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4,
      6, 1, 3, 5, 3, 7, 5;
  return mesh;
}

TriangleMesh RevolvedMesh(const std::vector<Vector2>& profile, int segments) {
  TriangleMesh mesh;
  const int rings = static_cast<int>(profile.size());
  mesh.V.resize(static_cast<Eigen::Index>(rings) * segments, 3);
  for (int i = 0; i < rings; ++i) {
    for (int k = 0; k < segments; ++k) {
      const double a = 2.0 * kPi * k / segments;
      mesh.V.row(i * segments + k) << profile[i].x() * std::cos(a), profile[i].x() * std::sin(a),
          profile[i].y();
    }
  }
  std::vector<Eigen::Vector3i> faces;
  for (int i = 0; i + 1 < rings; ++i) {
    for (int k = 0; k < segments; ++k) {
      const int a = i * segments + k, b = i * segments + (k + 1) % segments;
      if (profile[i].x() > 0.0) faces.emplace_back(a, b, b + segments);
      if (profile[i + 1].x() > 0.0) faces.emplace_back(a, b + segments, a + segments);
    }
  }
  mesh.F.resize(static_cast<Eigen::Index>(faces.size()), 3);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    mesh.F.row(static_cast<Eigen::Index>(f)) = faces[f];
  }
  return mesh;
}

TriangleMesh BallMesh(double radius) {
  std::vector<Vector2> profile;
  for (int i = 0; i <= 32; ++i) {
    const double a = kPi * i / 32;
    profile.emplace_back(i % 32 == 0 ? 0.0 : radius * std::sin(a), -radius * std::cos(a));
  }
  return RevolvedMesh(profile, 64);
}

RenderScene RulerScene() {
  RenderScene scene;
  scene.bodies.push_back(Placed(BoxMesh({0.8, 0.6, 0.04}), {-0.4, 0, -0.02}, TableColor(), 0.6F));
  scene.bodies.push_back(
      Placed(BoxMesh({0.30, 0.03, 0.003}), {-0.06, 0, 0.0015}, ObjectColor(), 0.45F));
  const Vector3 tip(-0.03, 0.0, 0.003 + 0.009);
  scene.bodies.push_back(Placed(BallMesh(0.009), tip, FingerColor(Finger::kIndex), 0.4F));
  const Vector3 contact(-0.03, 0.0, 0.003);
  scene.arrows.push_back({contact, Vector3(0.025, 0, -0.05), 0.0016F, FingerColor(Finger::kIndex)});
  scene.cones.push_back({contact, Vector3(0, 0, -0.04), 0.67F, FingerColor(Finger::kIndex)});
  RenderLine path;
  path.color = FingerColor(Finger::kIndex);
  for (int i = 0; i <= 20; ++i)
    path.p_W.emplace_back(-0.16 + 0.13 * i / 20, 0.0,
                          0.0125 + 0.03 * (1 - std::pow(i / 10.0 - 1, 2)));
  scene.lines.push_back(path);
  for (int i = 0; i < 20; i += 2)
    scene.points.push_back({path.p_W[i], 0.0022F, FingerColor(Finger::kIndex)});
  scene.labels.push_back({contact, "index 0.42 N", FingerColor(Finger::kIndex)});
  scene.labels.push_back({Vector3(0.09, 0.0, 0.003), "overhang 90 mm", ObjectColor()});
  scene.labels.push_back({Vector3(0.0, -0.2, 0.0), "table edge", NeutralColor()});
  scene.caption.title = "Ruler dragged over the edge";
  scene.caption.lines = {"step\tpath.1.certify", "time\t0.84 s", "force\t0.42 N of 12 N, μ = 0.8",
                         "pose\tx \u2192 +78.2 mm, tilt 0.3°",
                         "The index finger presses down and drags: 0.30 × 0.03 m, λ = 0.05."};
  scene.caption.footer = "pregrasp show out/ruler --step path.1.certify --camera default";
  scene.caption.progress = 0.42;
  MatrixX3 focus(4, 3);
  focus << -0.22, -0.08, 0, 0.10, 0.03, 0, -0.05, 0.1, 0.06, 0.12, -0.06, -0.04;
  scene.camera = FrameCamera(focus, Vector3(0.75, -0.95, 0.75), 16.0 / 9.0);
  return scene;
}

RenderScene ShelfScene() {
  RenderScene scene;
  scene.bodies.push_back(Placed(BoxMesh({0.30, 0.8, 0.02}), {0.03, 0, -0.01}, TableColor()));
  scene.bodies.push_back(Placed(BoxMesh({0.02, 0.8, 0.32}), {-0.11, 0, 0.14}, StaticColor()));
  const Vector3 book(0.155, 0.030, 0.230);
  for (int i = -3; i <= 3; ++i) {
    const bool object = i == 0;
    const double y = 0.031 * i;
    const Vector3 size =
        object ? book : Vector3(0.155 - 0.006 * (i & 1), 0.030, 0.230 - 0.012 * ((i + 4) % 3));
    scene.bodies.push_back(Placed(BoxMesh(size), {-0.02, y, 0.5 * size.z()},
                                  object ? ObjectColor() : NeighbourColor(), 0.6F));
  }
  auto mesh = std::make_shared<TriangleMesh>(BoxMesh(book));
  for (int i = 1; i <= 3; ++i) {
    RenderBody ghost;
    ghost.mesh = mesh;
    ghost.X_WB = MakeTransform(RotationFromRpy({0, 0.10 * i, 0}),
                               Vector3(-0.02 + 0.028 * i, 0, 0.115 + 0.004 * i));
    ghost.shading = Shading::kGhost;
    ghost.color = WithAlpha(ObjectColor(), 0.22F);
    scene.bodies.push_back(ghost);
  }
  scene.bodies.push_back(
      Placed(BallMesh(0.009), {-0.05, 0.0, 0.239}, FingerColor(Finger::kIndex), 0.4F));
  scene.labels.push_back({{0.0, 0.0, 0.23}, "book 0.6 kg", ObjectColor()});
  scene.labels.push_back({{-0.05, 0, 0.239}, "index 3.37 N", FingerColor(Finger::kIndex)});
  scene.labels.push_back({{0.0, 0.062, 0.2}, "neighbour", NeighbourColor()});
  scene.caption.title = "Book tipped out of a packed shelf";
  scene.caption.lines = {"stage\t2 of 3", "rollout\t17 of 128"};
  scene.caption.footer = "path.1.mppi.7   t = 1.400 s   seed 7";
  scene.caption.progress = 0.7;
  scene.axes = false;
  MatrixX3 focus(4, 3);
  focus << 0.1, -0.2, 0, 0.1, 0.2, 0, -0.1, -0.2, 0.24, 0.08, 0.2, 0.26;
  scene.camera = FrameCamera(focus, Vector3(1.0, -0.7, 0.55), 16.0 / 9.0);
  return scene;
}

RenderScene PlateScene() {
  RenderScene scene;
  scene.bodies.push_back(Placed(BoxMesh({0.9, 0.9, 0.03}), {0, 0, -0.015}, TableColor()));
  std::vector<Vector2> profile = {{0, 0.004},     {0.055, 0.004}, {0.060, 0.0},   {0.065, 0.0},
                                  {0.075, 0.005}, {0.110, 0.022}, {0.120, 0.026}, {0.120, 0.029},
                                  {0.108, 0.026}, {0.075, 0.010}, {0, 0.008}};
  RenderBody plate = Placed(RevolvedMesh(profile, 64), {0, 0, 0}, FromSrgb(0xF2F2EE), 0.25F);
  scene.bodies.push_back(plate);
  RenderBody scored =
      Placed(RevolvedMesh({{0, 0}, {0.05, 0.01}, {0.07, 0.05}, {0.05, 0.09}, {0, 0.1}}, 8),
             {0.22, 0.05, 0}, ObjectColor());
  scored.smooth = false;
  scored.edges = true;
  Rng rng(3);
  for (Eigen::Index f = 0; f < scored.mesh->F.rows(); ++f)
    scored.face_colors.push_back(ScoreColor(rng.Uniform()));
  scene.bodies.push_back(scored);
  scene.bodies.push_back(
      Placed(RevolvedMesh(
                 {{0, 0}, {0.035, 0}, {0.04, 0.09}, {0.037, 0.09}, {0.032, 0.004}, {0, 0.004}}, 64),
             {-0.2, 0.1, 0}, NeighbourColor(), 0.3F));
  scene.legend.title = "score of the node's best triangle";
  for (int i = 0; i <= 16; ++i) scene.legend.scale.push_back(ScoreColor(i / 16.0));
  scene.legend.ticks = {{0, "0.12"}, {0.5, "0.50"}, {1, "0.88"}};
  scene.legend.swatches = {{GoodColor(), "kept"}, {BadColor(), "pruned"}};
  scene.caption.title = "Contact mesh and scores";
  scene.caption.lines = {"nodes  : 1600", "kept   : 80  (5 %)"};
  MatrixX3 focus(3, 3);
  focus << -0.25, -0.12, 0, 0.28, 0.12, 0, 0.22, 0.05, 0.1;
  scene.camera = FrameCamera(focus, Vector3(0.3, -1, 0.7), 16.0 / 9.0);
  return scene;
}

RenderScene CrowdedScene() {
  RenderScene scene = RulerScene();
  auto ball = std::make_shared<TriangleMesh>(BallMesh(0.012));
  for (int i = 0; i < 16; ++i) {
    RenderBody body;
    body.mesh = ball;
    body.X_WB = MakeTransform(Matrix3(Matrix3::Identity()),
                              Vector3(-0.2 + 0.03 * (i % 8), 0.06 + 0.04 * (i / 8), 0.012));
    scene.bodies.push_back(WithLook(std::move(body), NeighbourColor(), 0.4F));
  }
  return scene;
}

}  // namespace pregrasp
