#include "app/pipeline/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/geometry/tessellate.h"
#include "app/pipeline/camera.h"
#include "app/pipeline/finger_stub.h"
#include "app/pipeline/forces.h"
#include "app/pipeline/motion_measure.h"
#include "render/hand_bodies.h"
#include "render/palette.h"

namespace pregrasp {
namespace {

constexpr double kFocusShare = 0.06;  // of the object's length, around it
constexpr double kHeadroom = 0.07;    // [m], above it
constexpr double kGhostAfter = 1e-3;  // [m]
constexpr double kGhostTurn = 0.01;   // [rad]

void Append(MatrixX3& points, const MatrixX3& more) {
  points.conservativeResize(points.rows() + more.rows(), 3);
  points.bottomRows(more.rows()) = more;
}

}  // namespace

void PictureConfig::Validate() const { RenderConfig{width, height, quality}.Validate(); }

struct PictureMaker::Impl {
  std::shared_ptr<const World> world;
  std::vector<std::shared_ptr<const TriangleMesh>> meshes;  // one a body
  Vector3 view_W;          // towards the viewer, in automatic pictures
  MatrixX3 start_focus_W;  // what they show at least: one camera for a strip, while that does
  double metres_per_newton = 0.0;

  RenderCamera ChooseCamera(const PictureConfig& config, const WorldState& state,
                            const PictureOverlay& overlay) const;
  void AddBodies(RenderScene& scene, const WorldState& state, const PictureOverlay& overlay) const;
  void AddGhost(RenderScene& scene, const RigidTransform& X_WO, const Rgba& color) const;
  void AddStartGhost(RenderScene& scene, const WorldState& state, const WorldState& start) const;
  void AddOverlay(RenderScene& scene, const PictureOverlay& overlay) const;
  void AddFinger(RenderScene& scene, const WorldState& state, Finger finger,
                 const PictureConfig& config) const;
  void AddArrow(RenderScene& scene, const Vector3& p_W, bool ends_there, const Vector3& f_W,
                const Rgba& color, const std::string& name) const;
};

PictureMaker::PictureMaker(std::shared_ptr<const World> world) : impl_(std::make_unique<Impl>()) {
  impl_->world = std::move(world);
  const Scene& scene = impl_->world->scene();
  for (const Body& body : scene.bodies) {
    impl_->meshes.push_back(std::make_shared<const TriangleMesh>(Tessellate(body.shape)));
  }
  TriangleMesh object_W = *impl_->meshes[0];
  object_W.V = TransformPoints(scene.object().X_WB, object_W.V);
  impl_->view_W = ChooseViewDirection(object_W, EnvironmentDistance(scene));
  impl_->start_focus_W = FocusAround(object_W.V, kFocusShare, kHeadroom);
  // The forces of a push are a few times the weight, and end at the cap.
  constexpr double kLongArrow = 0.07;  // [m]
  const double large =
      std::min(scene.fingertips.max_force, 2.5 * std::max(scene.object_weight(), 1e-3));
  impl_->metres_per_newton = kLongArrow / large;
}

PictureMaker::~PictureMaker() = default;

RenderCamera PictureMaker::Impl::ChooseCamera(const PictureConfig& config, const WorldState& state,
                                              const PictureOverlay& overlay) const {
  const auto& fixed = config.camera ? config.camera : world->scene().camera;
  if (fixed) return {fixed->p_WCam, fixed->p_WTarget, fixed->fov_deg};
  const double aspect = static_cast<double>(config.width) / config.height;
  MatrixX3 seen_W = TransformPoints(state.bodies[0].X_WB(), meshes[0]->V);
  for (const PictureOverlay::Ghost& ghost : overlay.ghosts) {
    Append(seen_W, TransformPoints(ghost.X_WO, meshes[0]->V));
  }
  Append(seen_W, overlay.focus_W);
  RenderCamera at_start = FrameCamera(start_focus_W, view_W, aspect);
  constexpr double kBorder = 0.08;
  if (IsInSight(at_start, seen_W, aspect, kBorder)) return at_start;
  MatrixX3 focus_W = start_focus_W;
  Append(focus_W, seen_W);
  return FrameCamera(focus_W, view_W, aspect);
}

void PictureMaker::Impl::AddBodies(RenderScene& scene, const WorldState& state,
                                   const PictureOverlay& overlay) const {
  const std::vector<RigidTransform> X_WB = world->GetPoses(state);
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    RenderBody body;
    body.mesh = meshes[i];
    body.X_WB = X_WB[i];
    if (i == 0 && overlay.contact_mesh) {
      body.mesh = overlay.contact_mesh;
      body.face_colors = overlay.face_colors;
      body.edges = true;
      body.smooth = false;
    }
    const bool movable = world->scene().bodies[i].movable();
    const Rgba color = i == 0 ? ObjectColor() : movable ? NeighbourColor() : TableColor();
    scene.bodies.push_back(WithLook(body, color, movable ? 0.5F : 0.7F));
  }
}

void PictureMaker::Impl::AddGhost(RenderScene& scene, const RigidTransform& X_WO,
                                  const Rgba& color) const {
  RenderBody body;
  body.mesh = meshes[0];
  body.X_WB = X_WO;
  body.color = color;
  body.shading = Shading::kGhost;
  scene.bodies.push_back(body);
}

void PictureMaker::Impl::AddStartGhost(RenderScene& scene, const WorldState& state,
                                       const WorldState& start) const {
  const Motion motion = CalcObjectMotion(*world, start, state);
  if (motion.moved <= kGhostAfter && motion.rotated <= kGhostTurn) return;
  AddGhost(scene, start.bodies[0].X_WB(), WithAlpha(ObjectColor(), 0.35F));
}

void PictureMaker::Impl::AddOverlay(RenderScene& scene, const PictureOverlay& overlay) const {
  for (const PictureOverlay::Ghost& ghost : overlay.ghosts) {
    AddGhost(scene, ghost.X_WO, ghost.color);
  }
  if (overlay.hand) AddHand(scene, *overlay.hand, overlay.touching);
  scene.legend = overlay.legend;
}

void PictureMaker::Impl::AddArrow(RenderScene& scene, const Vector3& p_W, bool ends_there,
                                  const Vector3& f_W, const Rgba& color,
                                  const std::string& name) const {
  constexpr double kShortest = 0.02, kLongest = 0.10;  // [m]
  const double force = f_W.norm();
  if (force < 1e-3) return;
  const double length = std::clamp(metres_per_newton * force, kShortest, kLongest);
  const Vector3 v_W = f_W * (length / force);
  const Vector3 tail_W = ends_there ? Vector3(p_W - v_W) : p_W;
  scene.arrows.push_back({tail_W, v_W, 0.0016F, color});
  scene.labels.push_back({tail_W, fmt::format("{} {:.2f} N", name, force), color});
}

void PictureMaker::Impl::AddFinger(RenderScene& scene, const WorldState& state, Finger finger,
                                   const PictureConfig& config) const {
  const FingertipState& tip = state.fingers[static_cast<int>(finger)];
  if (!tip.on) return;
  const Vector3 nhat_W = state.bodies[0].q_WB * tip.nhat_O;
  const Vector3 to_viewer_W = (scene.camera.p_WCam - tip.p_WF).normalized();
  if (config.fingers) {
    for (RenderBody& body : MakeFingerStub(finger, tip.p_WF, nhat_W, to_viewer_W)) {
      scene.bodies.push_back(std::move(body));
    }
  }
  if (config.cones && tip.touching) {
    RenderCone cone;
    cone.p_W = tip.p_WF;
    cone.axis_W = 0.035 * nhat_W;
    cone.half_angle = static_cast<float>(std::atan(world->scene().fingertips.friction));
    cone.color = WithAlpha(tip.slipping ? BadColor() : GoodColor(), 0.22F);
    scene.cones.push_back(cone);
  }
  if (config.forces) {
    AddArrow(scene, tip.p_WF, true, tip.f_W, FingerColor(finger), FingerName(finger));
  }
}

namespace {

// What of a stage's overlay is to be shown.
PictureOverlay Chosen(const PictureOverlay* overlay, const PictureConfig& config) {
  PictureOverlay chosen = overlay == nullptr ? PictureOverlay{} : *overlay;
  if (!config.mesh) chosen.contact_mesh = nullptr;
  if (!config.scores) {
    std::fill(chosen.face_colors.begin(), chosen.face_colors.end(), WithAlpha(ObjectColor(), 1.0F));
    chosen.legend = {};
  }
  if (!config.rollouts) chosen.ghosts.clear();
  if (!config.hand) chosen.hand.reset();
  return chosen;
}

// At each contact point the normal and the force: where the object takes part, into it and on it,
// else into and on the second body. Normals have one length, forces the pictures' scale.
void AddContactArrows(RenderScene& scene, const std::vector<ContactPoint>& contacts,
                      double metres_per_newton) {
  constexpr double kNormalLength = 0.012;             // [m]
  constexpr float kThin = 0.0005F, kThick = 0.0012F;  // [m]
  for (const ContactPoint& contact : contacts) {
    const double sign = contact.body_a == kObjectBody ? -1.0 : 1.0;
    scene.arrows.push_back(
        {contact.p_WC, sign * kNormalLength * contact.nhat_W, kThin, NeutralColor()});
    const Vector3 v_W = sign * metres_per_newton * contact.f_W;
    if (v_W.norm() > 1e-3) scene.arrows.push_back({contact.p_WC, v_W, kThick, GoodColor()});
  }
}

}  // namespace

RenderScene PictureMaker::Compose(const WorldState& state,
                                  const std::vector<ContactPoint>& contacts,
                                  const WorldState& start, const PictureOverlay* stage_overlay,
                                  const PictureText& text, const PictureConfig& config) const {
  config.Validate();
  const PictureOverlay overlay = Chosen(stage_overlay, config);
  RenderScene scene;
  scene.camera = impl_->ChooseCamera(config, state, overlay);
  impl_->AddBodies(scene, state, overlay);
  if (config.ghost) impl_->AddStartGhost(scene, state, start);
  for (int i = 0; i < kNumFingers && !overlay.hand; ++i) {
    impl_->AddFinger(scene, state, static_cast<Finger>(i), config);
  }
  impl_->AddOverlay(scene, overlay);
  if (config.contacts) {
    for (const ContactPoint& contact : contacts) {
      if (contact.body_a != kObjectBody || contact.f_W.norm() < 1e-3) continue;
      scene.points.push_back({contact.p_WC, 0.0022F, NeutralColor()});
    }
  }
  if (config.trace) AddContactArrows(scene, contacts, impl_->metres_per_newton);
  if (config.forces && overlay.forces) {
    const Body& object = impl_->world->scene().object();
    const Vector3 p_WBcm = state.bodies[0].X_WB() * object.mass_properties->p_BoBcm;
    const Vector3 weight_W = object.mass_properties->mass * impl_->world->scene().gravity;
    impl_->AddArrow(scene, p_WBcm, false, weight_W, NeutralColor(), "weight");
  }
  scene.axes = config.axes;
  scene.caption = {text.title, text.lines, text.footer, -1.0};
  return scene;
}

}  // namespace pregrasp
