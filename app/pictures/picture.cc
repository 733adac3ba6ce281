#include "app/pictures/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "app/core/check.h"
#include "app/geometry/signed_distance.h"
#include "app/geometry/tessellate.h"
#include "app/hand/hand_shapes.h"
#include "app/pictures/camera.h"
#include "app/pictures/finger_stub.h"
#include "app/pictures/forces.h"
#include "app/pictures/overlay.h"
#include "render/hand_bodies.h"
#include "render/palette.h"
#include "render/upright.h"

namespace pregrasp {
namespace {

constexpr double kFocusShare = 0.06;  // of the object's length, around it
constexpr double kHeadroom = 0.07;    // [m], above it, of a full-size object
constexpr double kFullSize = 0.05;    // [m]; arrows and points shrink with objects below this
constexpr double kNearFinger = 0.75;  // of what is seen, from its middle
constexpr double kNoForce = 1e-3;     // [N], below which there is no arrow
constexpr double kGhostAfter = 1e-3;  // [m]
constexpr double kGhostTurn = 0.01;   // [rad]

void Append(MatrixX3& points, const MatrixX3& more) {
  points.conservativeResize(points.rows() + more.rows(), 3);
  points.bottomRows(more.rows()) = more;
}

}  // namespace

double ForceScale::Length(double newtons) const {
  constexpr double kShortest = 0.02, kLongest = 0.10;  // [m]
  return std::clamp(metres_per_newton * newtons, kShortest * shrunk, kLongest * shrunk);
}

namespace {

ForceScale MakeForceScale(const Scene& scene, const TriangleMesh& object_W) {
  const Vector3 size = object_W.V.colwise().maxCoeff() - object_W.V.colwise().minCoeff();
  ForceScale scale;
  scale.shrunk = std::min(1.0, size.maxCoeff() / kFullSize);
  // The forces of a push are a few times the weight, and end at the cap.
  constexpr double kLongArrow = 0.07;  // [m]
  const double large =
      std::min(scene.fingertips.max_force, 2.5 * std::max(scene.object_weight(), 1e-3));
  scale.metres_per_newton = kLongArrow * scale.shrunk / large;
  return scale;
}

}  // namespace

ForceScale CalcForceScale(const Scene& scene) {
  TriangleMesh object_W = Tessellate(scene.object().shape);
  object_W.V = TransformPoints(scene.object().X_WB, object_W.V);
  return MakeForceScale(scene, object_W);
}

void PictureConfig::Validate() const {
  RenderConfig{width, height, quality}.Validate();
  RequireWithin("", "font_scale", kFontScale, font_scale);
}

struct PictureMaker::Impl {
  explicit Impl(Scene the_scene) : scene(std::move(the_scene)), hand(HandOf(scene)) {}

  Scene scene;
  const HandModel& hand;
  std::vector<std::shared_ptr<const TriangleMesh>> meshes;  // one a body
  Vector3 up_W;                                             // against gravity
  Matrix3 R_UW;                                             // to a frame U in which that is +z
  Vector3 view_U;          // towards the viewer, in automatic pictures
  MatrixX3 start_focus_U;  // what they show at least: one camera for a strip, while that does
  ForceScale scale;

  // What a picture of the step is framed on.
  MatrixX3 FindFocus(const StepFacts& step, const PictureOverlay& overlay,
                     const PictureConfig& config) const;
  RenderCamera ChooseCamera(const PictureConfig& config, const StepFacts& step,
                            const PictureOverlay& overlay) const;
  void AddBodies(RenderScene& picture, const StepFacts& step, const PictureOverlay& overlay) const;
  void AddGhost(RenderScene& picture, const RigidTransform& X_WO, const Rgba& color) const;
  void AddStartGhost(RenderScene& picture, const StepFacts& step, const StepFacts& start) const;
  void AddOverlay(RenderScene& picture, const PictureOverlay& overlay) const;
  void AddFinger(RenderScene& picture, const StepFacts& step, const FingerFacts& finger,
                 const PictureConfig& config) const;
  void AddContact(RenderScene& picture, const PictureOverlay::Contact& contact, bool with_stub,
                  const PictureConfig& config) const;
  void AddWay(RenderScene& picture, const PictureOverlay::Way& way) const;
  void AddTriangleLabels(RenderScene& picture, const StepFacts& step,
                         const PictureOverlay& overlay) const;
  void AddArrow(RenderScene& picture, const Vector3& p_W, bool ends_there, const Vector3& f_W,
                const Rgba& color, const std::string& name) const;
};

PictureMaker::PictureMaker(Scene loaded) : impl_(std::make_unique<Impl>(std::move(loaded))) {
  const Scene& scene = impl_->scene;
  for (const Body& body : scene.bodies) {
    impl_->meshes.push_back(std::make_shared<const TriangleMesh>(Tessellate(body.shape)));
  }
  TriangleMesh object_W = *impl_->meshes[0];
  object_W.V = TransformPoints(scene.object().X_WB, object_W.V);
  impl_->up_W = -scene.gravity.normalized();
  impl_->R_UW = UprightRotation(impl_->up_W);
  impl_->view_U =
      impl_->R_UW * ChooseViewDirection(object_W, EnvironmentDistance(scene), impl_->up_W);
  impl_->scale = MakeForceScale(scene, object_W);
  impl_->start_focus_U = FocusAround(object_W.V * impl_->R_UW.transpose(), kFocusShare,
                                     kHeadroom * impl_->scale.shrunk);
}

PictureMaker::~PictureMaker() = default;

namespace {

// Corners of the boxes around the hand's parts.
MatrixX3 HandCorners(const HandModel& hand, const HandConfiguration& configuration) {
  const auto X_WL = CalcLinkPoses(hand, configuration);
  MatrixX3 corners(0, 3);
  for (const HandShape& shape : ShapesOf(hand)) {
    Append(corners, TransformPoints(X_WL[shape.link], FocusAround(shape.mesh->V, 0.0, 0.0)));
  }
  return corners;
}

}  // namespace

MatrixX3 PictureMaker::Impl::FindFocus(const StepFacts& step, const PictureOverlay& overlay,
                                       const PictureConfig& config) const {
  MatrixX3 seen_W = TransformPoints(step.object().X_WB(), meshes[0]->V);
  for (const PictureOverlay::Ghost& ghost : overlay.ghosts) {
    Append(seen_W, TransformPoints(ghost.X_WO, meshes[0]->V));
  }
  Append(seen_W, overlay.focus_W);
  // Fingers, but for those that have left: what they are far from would be small.
  const Vector3 size = seen_W.colwise().maxCoeff() - seen_W.colwise().minCoeff(),
                middle_W = 0.5 * (seen_W.colwise().maxCoeff() + seen_W.colwise().minCoeff());
  for (const PictureOverlay::Contact& contact : overlay.contacts) {
    const double force = contact.f_W.norm();
    if (!config.forces || force < kNoForce) continue;
    const Vector3 tail_W = contact.p_W - contact.f_W * (scale.Length(force) / force);
    Append(seen_W, MatrixX3(tail_W.transpose()));
  }
  for (const FingerFacts& finger : step.fingers) {
    if (overlay.hand || !overlay.contacts.empty() || !finger.on) continue;
    const bool near = (finger.p_WF - middle_W).norm() < kNearFinger * size.maxCoeff();
    if (config.fingers && (finger.touching || near)) {
      const double radius = scene.tips.radius(finger.finger);
      const Vector3 p_WTip = finger.p_WF + radius * (step.object().q_WB * finger.nhat_O);
      MatrixX3 ends(2, 3);
      ends << (p_WTip.array() - radius).matrix().transpose(),
          (p_WTip.array() + radius).matrix().transpose();
      Append(seen_W, FocusAround(ends, 0.0, 0.0));
    }
    const double force = finger.f_W.norm();
    if (!config.forces || force < kNoForce) continue;
    const Vector3 tail_W = finger.p_WF - finger.f_W * (scale.Length(force) / force);
    Append(seen_W, MatrixX3(tail_W.transpose()));
  }
  return seen_W;
}

RenderCamera PictureMaker::Impl::ChooseCamera(const PictureConfig& config, const StepFacts& step,
                                              const PictureOverlay& overlay) const {
  const auto& fixed = config.camera ? config.camera : scene.camera;
  if (fixed) return {fixed->p_WCam, fixed->p_WTarget, fixed->fov_deg};
  const double aspect = static_cast<double>(config.width) / config.height;
  const MatrixX3 seen_U = FindFocus(step, overlay, config) * R_UW.transpose();
  RenderCamera camera_U = FrameCamera(start_focus_U, view_U, aspect);
  constexpr double kBorder = 0.08;
  if (!IsInSight(camera_U, seen_U, aspect, kBorder)) {
    MatrixX3 focus_U = start_focus_U;
    Append(focus_U, seen_U);
    camera_U = FrameCamera(focus_U, view_U, aspect);
  }
  return Rotated(camera_U, R_UW.transpose());
}

void PictureMaker::Impl::AddBodies(RenderScene& picture, const StepFacts& step,
                                   const PictureOverlay& overlay) const {
  std::size_t movable = 0;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const bool moves = scene.bodies[i].movable();
    RenderBody body;
    body.mesh = meshes[i];
    body.X_WB = moves ? step.bodies.at(movable++).X_WB() : scene.bodies[i].X_WB;
    if (i == 0 && overlay.contact_mesh) {
      body.mesh = overlay.contact_mesh;
      body.face_colors = overlay.face_colors;
      body.edges = true;
      body.smooth = false;
    }
    const Rgba color = i == 0 ? ObjectColor() : moves ? NeighbourColor() : TableColor();
    picture.bodies.push_back(WithLook(body, color, moves ? 0.5F : 0.7F));
  }
}

void PictureMaker::Impl::AddGhost(RenderScene& picture, const RigidTransform& X_WO,
                                  const Rgba& color) const {
  RenderBody body;
  body.mesh = meshes[0];
  body.X_WB = X_WO;
  body.color = color;
  body.shading = Shading::kGhost;
  picture.bodies.push_back(body);
}

void PictureMaker::Impl::AddStartGhost(RenderScene& picture, const StepFacts& step,
                                       const StepFacts& start) const {
  const RigidTransform X_from = start.object().X_WB(), X_to = step.object().X_WB();
  const Vector3& p_OOcm = scene.object().mass_properties->p_BoBcm;
  const bool left = (X_to * p_OOcm - X_from * p_OOcm).norm() > kGhostAfter ||
                    RotationAngle(X_from.linear(), X_to.linear()) > kGhostTurn;
  if (left) AddGhost(picture, X_from, WithAlpha(ObjectColor(), 0.35F));
}

void PictureMaker::Impl::AddOverlay(RenderScene& picture, const PictureOverlay& overlay) const {
  for (const PictureOverlay::Ghost& ghost : overlay.ghosts) {
    AddGhost(picture, ghost.X_WO, ghost.color);
    picture.bodies.back().shading = Shading::kOutline;
  }
  if (overlay.hand) {
    AddHand(picture, hand, *overlay.hand, overlay.touching, overlay.colliding);
  }
  picture.legend = overlay.legend;
}

void PictureMaker::Impl::AddArrow(RenderScene& picture, const Vector3& p_W, bool ends_there,
                                  const Vector3& f_W, const Rgba& color,
                                  const std::string& name) const {
  const double force = f_W.norm();
  if (force < kNoForce) return;
  const Vector3 v_W = f_W * (scale.Length(force) / force);
  const Vector3 tail_W = ends_there ? Vector3(p_W - v_W) : p_W;
  picture.arrows.push_back({tail_W, v_W, static_cast<float>(0.0016 * scale.shrunk), color});
  picture.labels.push_back({tail_W, fmt::format("{} {:.2f} N", name, force), color});
}

void PictureMaker::Impl::AddFinger(RenderScene& picture, const StepFacts& step,
                                   const FingerFacts& finger, const PictureConfig& config) const {
  if (!finger.on) return;
  const Vector3 nhat_W = step.object().q_WB * finger.nhat_O;
  const Vector3 to_viewer_W = (picture.camera.p_WCam - finger.p_WF).normalized();
  if (config.fingers) {
    for (RenderBody& body : MakeFingerStub(finger.finger, scene.tips.radius(finger.finger),
                                           finger.p_WF, nhat_W, to_viewer_W)) {
      picture.bodies.push_back(std::move(body));
    }
  }
  if (config.cones && finger.touching) {
    RenderCone cone;
    cone.p_W = finger.p_WF;
    cone.axis_W = 0.035 * nhat_W;
    cone.half_angle = static_cast<float>(std::atan(scene.fingertips.friction));
    cone.color = WithAlpha(finger.slipping ? BadColor() : GoodColor(), 0.22F);
    picture.cones.push_back(cone);
  }
  if (config.forces) {
    AddArrow(picture, finger.p_WF, true, finger.f_W, FingerColor(finger.finger),
             FingerName(finger.finger));
  }
}

void PictureMaker::Impl::AddContact(RenderScene& picture, const PictureOverlay::Contact& contact,
                                    bool with_stub, const PictureConfig& config) const {
  const Rgba color = FingerColor(contact.finger);
  if (config.fingers && with_stub) {
    const Vector3 to_viewer_W = (picture.camera.p_WCam - contact.p_W).normalized();
    for (RenderBody& body : MakeFingerStub(contact.finger, scene.tips.radius(contact.finger),
                                           contact.p_W, contact.nhat_W, to_viewer_W)) {
      picture.bodies.push_back(std::move(body));
    }
  }
  if (config.cones) {
    RenderCone cone;
    cone.p_W = contact.p_W;
    cone.axis_W = 0.035 * contact.nhat_W;
    cone.half_angle = static_cast<float>(std::atan(scene.fingertips.friction));
    cone.color = WithAlpha(contact.holds ? GoodColor() : BadColor(), 0.22F);
    picture.cones.push_back(cone);
  }
  if (!config.forces) return;
  if (contact.f_W.norm() < kNoForce) {
    picture.labels.push_back({contact.p_W, contact.name, color});
  } else {
    AddArrow(picture, contact.p_W, true, contact.f_W, color, contact.name);
  }
}

void PictureMaker::Impl::AddWay(RenderScene& picture, const PictureOverlay::Way& way) const {
  const Rgba color = FingerColor(way.finger);
  const auto radius = static_cast<float>(0.0025 * scale.shrunk);
  picture.points.push_back({way.p_W.front(), radius, color});
  for (std::size_t i = 1; i < way.p_W.size(); ++i) {
    const Vector3 v_W = way.p_W[i] - way.p_W[i - 1];
    const auto thin = static_cast<float>(0.0012 * scale.shrunk);
    picture.arrows.push_back({way.p_W[i - 1], v_W, thin, color});
  }
  picture.labels.push_back({way.p_W.front(), way.name, color});
}

void PictureMaker::Impl::AddTriangleLabels(RenderScene& picture, const StepFacts& step,
                                           const PictureOverlay& overlay) const {
  if (overlay.contact_mesh == nullptr) return;
  const TriangleMesh& mesh = *overlay.contact_mesh;
  const RigidTransform X_WO = step.object().X_WB();
  for (const PictureOverlay::TriangleLabel& label : overlay.triangle_labels) {
    const Vector3 a = X_WO * Vector3(mesh.V.row(mesh.F(label.triangle, 0))),
                  b = X_WO * Vector3(mesh.V.row(mesh.F(label.triangle, 1))),
                  c = X_WO * Vector3(mesh.V.row(mesh.F(label.triangle, 2)));
    const Vector3 middle_W = (a + b + c) / 3.0;
    const bool away = (b - a).cross(c - a).dot(picture.camera.p_WCam - middle_W) < 0.0;
    picture.labels.push_back({middle_W, label.text + (away ? ", far side" : ""), label.color});
  }
}

namespace {

// What of a step's overlay is to be shown.
PictureOverlay Chosen(PictureOverlay overlay, const PictureConfig& config) {
  if (!config.mesh) overlay.contact_mesh = nullptr;
  if (!config.scores) {
    overlay.triangle_labels.clear();
    std::fill(overlay.face_colors.begin(), overlay.face_colors.end(),
              WithAlpha(ObjectColor(), 1.0F));
    overlay.legend = {};
  }
  if (!config.rollouts) overlay.ghosts.clear();
  if (!config.hand) overlay.hand.reset();
  return overlay;
}

// At each contact point the normal and the force: where the object takes part, into it and on it,
// else into and on the second body. Normals have one length, forces the pictures' scale.
void AddContactArrows(RenderScene& picture, const std::vector<ContactFacts>& contacts,
                      const ForceScale& scale) {
  const double normal_length = 0.012 * scale.shrunk;  // [m]
  const auto thin = static_cast<float>(0.0005 * scale.shrunk),
             thick = static_cast<float>(0.0012 * scale.shrunk);
  for (const ContactFacts& contact : contacts) {
    const double sign = contact.a == 0 ? -1.0 : 1.0;
    picture.arrows.push_back(
        {contact.p_W, sign * normal_length * contact.nhat_W, thin, NeutralColor()});
    const Vector3 v_W = sign * scale.metres_per_newton * contact.f_W;
    if (v_W.norm() > 1e-3 * scale.shrunk) {
      picture.arrows.push_back({contact.p_W, v_W, thick, GoodColor()});
    }
  }
}

}  // namespace

RenderScene PictureMaker::Compose(const StepFacts& step, const FactsSource& steps,
                                  const PictureText& text, const PictureConfig& config) const {
  config.Validate();
  const PictureOverlay overlay = Chosen(MakeOverlay(step, steps, impl_->hand), config);
  const Scene& scene = impl_->scene;
  RenderScene picture;
  picture.camera = impl_->ChooseCamera(config, step, overlay);
  impl_->AddBodies(picture, step, overlay);
  if (config.ghost) impl_->AddStartGhost(picture, step, FindStart(step, steps));
  if (!overlay.hand && overlay.contacts.empty()) {
    for (const FingerFacts& finger : step.fingers) {
      impl_->AddFinger(picture, step, finger, config);
    }
  }
  impl_->AddOverlay(picture, overlay);
  for (const PictureOverlay::Contact& contact : overlay.contacts) {
    impl_->AddContact(picture, contact, !overlay.hand, config);
  }
  if (config.forces) {
    for (const PictureOverlay::Way& way : overlay.ways) impl_->AddWay(picture, way);
  }
  impl_->AddTriangleLabels(picture, step, overlay);
  if (config.contacts) {
    for (const ContactFacts& contact : step.contacts) {
      if (contact.a != 0 || contact.f_W.norm() < 1e-3) continue;
      picture.points.push_back(
          {contact.p_W, static_cast<float>(0.0022 * impl_->scale.shrunk), NeutralColor()});
    }
  }
  if (config.trace) AddContactArrows(picture, step.contacts, impl_->scale);
  if (config.forces && overlay.forces) {
    const MassProperties& mass = *scene.object().mass_properties;
    impl_->AddArrow(picture, step.object().X_WB() * mass.p_BoBcm, false, mass.mass * scene.gravity,
                    NeutralColor(), "weight");
  }
  picture.up_W = impl_->up_W;
  picture.axes = config.axes;
  picture.font_scale = config.font_scale;
  picture.fixed_corners = config.fixed_corners;
  if (config.card) {
    picture.caption.title = text.title;
    picture.caption.lines = text.lines;
  }
  if (config.footer) picture.caption.footer = text.footer;
  if (!config.legend) picture.legend = {};
  return picture;
}

namespace {

// Whether the step's hand is still on its way from afar.
bool IsOnItsWay(const StepFacts& step) {
  const auto* frame = std::get_if<FrameFacts>(&step.details);
  return frame != nullptr && frame->phase == "approach";
}

// Whether the step frames nothing but itself, as all others would be small: its object was dropped,
// as its lift failed or it is far below where it began, or the hand is on its way.
bool IsAside(const StepFacts& step, double lowest_z, double start_z) {
  constexpr double kFar = 0.5;  // [m], below which no hand hangs that takes hold at the start
  if (IsOnItsWay(step)) return true;
  const auto* lift = std::get_if<LiftFacts>(&step.details);
  return (lift != nullptr && !lift->held) || lowest_z < start_z - kFar;
}

}  // namespace

MatrixX3 PictureMaker::CalcFocus(const std::vector<const StepFacts*>& shown,
                                 const FactsSource& steps, const PictureConfig& config) const {
  PREGRASP_CHECK(!shown.empty());
  MatrixX3 focus_U = impl_->start_focus_U;
  const double start_z = focus_U.col(2).minCoeff();
  for (const StepFacts* step : shown) {
    PictureOverlay overlay = Chosen(MakeOverlay(*step, steps, impl_->hand), config);
    // This step's hand alone, not those before it in its motion.
    if (overlay.hand) overlay.focus_W = HandCorners(impl_->hand, *overlay.hand);
    // The outermost do: a mesh may have any number of points.
    const MatrixX3 seen_U =
        FindOutermost(impl_->FindFocus(*step, overlay, config) * impl_->R_UW.transpose());
    if (shown.size() > 1 && IsAside(*step, seen_U.col(2).minCoeff(), start_z)) continue;
    Append(focus_U, seen_U);
  }
  return focus_U * impl_->R_UW;
}

CameraConfig PictureMaker::Frame(const MatrixX3& focus_W, const PictureConfig& config,
                                 const std::optional<Vector3>& view) const {
  if (impl_->scene.camera && !view) return *impl_->scene.camera;
  const RenderCamera camera =
      Rotated(FrameCamera(focus_W * impl_->R_UW.transpose(), view.value_or(impl_->view_U),
                          static_cast<double>(config.width) / config.height),
              impl_->R_UW.transpose());
  return {camera.p_WCam, camera.p_WTarget, camera.fov_deg};
}

namespace {

// `camera`, moved back along its direction until it shows all points. @param R_UW  W to upright.
CameraConfig MovedBack(const CameraConfig& camera, const MatrixX3& seen_W, const Matrix3& R_UW,
                       const PictureConfig& config) {
  constexpr double kStep = 1.1;
  constexpr int kMostSteps = 40;  // to 45 times as far
  const double aspect = static_cast<double>(config.width) / config.height;
  const MatrixX3 seen_U = seen_W * R_UW.transpose();
  CameraConfig moved = camera;
  for (int i = 0; i < kMostSteps; ++i) {
    const RenderCamera camera_U = Rotated({moved.p_WCam, moved.p_WTarget, moved.fov_deg}, R_UW);
    if (IsInSight(camera_U, seen_U, aspect, 0.0)) break;
    moved.p_WCam = moved.p_WTarget + kStep * (moved.p_WCam - moved.p_WTarget);
  }
  return moved;
}

}  // namespace

CameraConfig PictureMaker::FrameOnWay(const CameraConfig& camera, const StepFacts& step,
                                      const FactsSource& steps, const PictureConfig& config) const {
  if (!IsOnItsWay(step)) return camera;
  return MovedBack(camera, CalcFocus({&step}, steps, config), impl_->R_UW, config);
}

namespace {

bool HaveOneShape(const PictureConfig& a, const PictureConfig& b) {
  return static_cast<std::int64_t>(a.width) * b.height ==
         static_cast<std::int64_t>(b.width) * a.height;
}

}  // namespace

void PictureMaker::ShareCamera(std::vector<StepPicture>& pictures, const FactsSource& steps) const {
  if (impl_->scene.camera) return;  // which all of them have
  struct Group {
    const PictureConfig* shape;
    std::vector<std::pair<StepPicture*, MatrixX3>> members;
  };
  std::vector<Group> groups;
  for (StepPicture& picture : pictures) {
    if (picture.config.camera) continue;
    auto group = std::find_if(groups.begin(), groups.end(), [&](const Group& each) {
      return HaveOneShape(*each.shape, picture.config);
    });
    if (group == groups.end()) group = groups.insert(group, Group{&picture.config, {}});
    group->members.emplace_back(&picture, CalcFocus({picture.step}, steps, picture.config));
  }
  const double start_z = impl_->start_focus_U.col(2).minCoeff();
  for (Group& group : groups) {
    MatrixX3 focus_W = impl_->start_focus_U * impl_->R_UW;
    std::vector<bool> aside;
    for (const auto& [picture, seen_W] : group.members) {
      const double lowest_z = (seen_W * impl_->up_W).minCoeff();
      aside.push_back(IsAside(*picture->step, lowest_z, start_z));
      if (!aside.back()) Append(focus_W, seen_W);
    }
    const CameraConfig camera = Frame(focus_W, *group.shape);
    const double aspect = static_cast<double>(group.shape->width) / group.shape->height;
    const RenderCamera camera_U =
        Rotated({camera.p_WCam, camera.p_WTarget, camera.fov_deg}, impl_->R_UW);
    for (std::size_t i = 0; i < group.members.size(); ++i) {
      const auto& [picture, seen_W] = group.members[i];
      const MatrixX3 seen_U = seen_W * impl_->R_UW.transpose();
      if (IsOnItsWay(*picture->step)) {
        picture->config.camera = MovedBack(camera, seen_W, impl_->R_UW, *group.shape);
      } else if (!aside[i] || IsInSight(camera_U, seen_U, aspect, 0.0)) {
        picture->config.camera = camera;
      }
    }
  }
}

}  // namespace pregrasp
