// hand_pictures DIRECTORY: the hand in ten poses, and its collision capsules, as PNG files to look
// at.
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>

#include "app/geometry/tessellate.h"
#include "app/hand/hand_shapes.h"
#include "app/hand/ik.h"
#include "render/hand_bodies.h"
#include "render/renderer.h"

namespace pregrasp {
namespace {

struct Pose {
  const char* name;
  HandJoints q;
  Vector3 dir_H;  ///< from the hand to the camera
  std::shared_ptr<const TriangleMesh> object;
  RigidTransform X_HO = RigidTransform::Identity();
};

// The nearest posture without self-collision. In degrees: index 4, middle 4, ring 4, little 5,
// thumb 5.
HandJoints Free(std::initializer_list<double> degrees) {
  HandConfiguration wanted;
  int j = 0;
  for (const double d : degrees) wanted.q[j++] = DegToRad(d);
  IkProblem problem;
  problem.reference = problem.warm_start = wanted;
  return IkSolver(ShadowHand()).Solve({}, problem, Rng(1, RngStream::kTest)).q;
}

// The hand around an object, by inverse kinematics.
Pose Grasp(const char* name, const Shape& object, const std::vector<IkContact>& contacts,
           const Vector3& dir_H) {
  IkProblem problem;
  problem.contacts = contacts;
  problem.X_WB = {RigidTransform::Identity()};
  const IkResult result =
      IkSolver(ShadowHand(), {&object}).Solve({}, problem, Rng(3, RngStream::kTest));
  std::printf("%s: %s, clearance %.2f mm, tip error %.3f mm\n", name, IkStatusName(result.status),
              1e3 * result.clearance, 1e3 * result.tip_error);
  return {name, result.q, dir_H, std::make_shared<TriangleMesh>(Tessellate(object, 96)),
          result.X_WH.inverse()};
}

// Contacts on a sphere or a round bar along z, by azimuth in degrees and height.
std::vector<IkContact> Around(double radius, const std::vector<std::array<double, 3>>& places) {
  std::vector<IkContact> contacts;
  for (const auto& [finger, azimuth, z] : places) {
    const Vector3 nhat(std::cos(DegToRad(azimuth)), std::sin(DegToRad(azimuth)), 0.0);
    contacts.push_back({static_cast<Finger>(static_cast<int>(finger)),
                        radius * nhat + Vector3(0.0, 0.0, z), nhat});
  }
  return contacts;
}

std::vector<Pose> Poses() {
  const HandJoints relaxed = ShadowHand().posture;
  const HandJoints open = Free({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 10, 0, 0, 0});
  const HandJoints spread =
      Free({-18, 0, 0, 0, -2, 0, 0, 0, -12, 0, 0, 0, 0, -20, 0, 0, 0, -40, 20, 0, -20, 0});
  const HandJoints fist =
      Free({0, 80, 90, 60, 0, 80, 90, 60, 0, 80, 90, 60, 0, 0, 80, 90, 60, 35, 65, 0, 10, 60});
  const HandJoints point =
      Free({0, 5, 5, 5, 0, 80, 90, 60, 0, 80, 90, 60, 0, 0, 80, 90, 60, 45, 65, 0, 10, 50});
  const HandJoints hook =
      Free({0, 0, 85, 60, 0, 0, 85, 60, 0, 0, 85, 60, 0, 0, 0, 85, 60, -10, 10, 0, 0, 10});
  const Vector3 palmar(0.35, -1.0, 0.15);
  const Vector3 dorsal(0.5, 1.0, 0.25);
  const Vector3 side(1.0, -0.45, 0.1);
  return {
      {"relaxed", relaxed, palmar, nullptr},
      {"relaxed_back", relaxed, dorsal, nullptr},
      {"open", open, palmar, nullptr},
      {"spread", spread, palmar, nullptr},
      {"fist", fist, side, nullptr},
      {"point", point, side, nullptr},
      {"hook", hook, side, nullptr},
      Grasp("pinch", Sphere{0.012}, Around(0.012, {{0, 180, 0}, {1, 0, 0}}), side),
      Grasp("tripod", Cylinder{0.006, 0.13},
            Around(0.006, {{0, 180, 0.03}, {1, 30, 0.04}, {2, -30, 0.018}}), side),
      Grasp("ball", Sphere{0.036},
            Around(0.036, {{0, 180, 0}, {1, 55, 0}, {2, 18, 0}, {3, -18, 0}, {4, -55, 0}}), side),
      Grasp("can", Cylinder{0.033, 0.12},
            Around(0.033,
                   {{0, 180, 0.01}, {1, 0, 0.036}, {2, 0, 0.012}, {3, 0, -0.012}, {4, 0, -0.036}}),
            palmar)};
}

RenderScene MakeScene(const Pose& pose, bool capsules) {
  // The hand stands upright, palm to the camera's side.
  const RigidTransform X_WH = MakeTransform(Matrix3::Identity(), Vector3(0.0, 0.0, 0.08));
  RenderScene scene;
  AddHand(scene, ShadowHand(), {X_WH, pose.q});
  if (pose.object) {
    RenderBody body;
    body.mesh = pose.object;
    body.X_WB = X_WH * pose.X_HO;
    body.color = {0.75F, 0.45F, 0.10F};
    scene.bodies.push_back(body);
  }
  if (capsules) {
    const auto X_WL = CalcLinkPoses(ShadowHand(), {X_WH, pose.q});
    for (const HandCapsule& capsule : ShadowHand().capsules) {
      const Vector3 axis = capsule.p_LB - capsule.p_LA;
      RenderBody body;
      body.mesh = std::make_shared<TriangleMesh>(Tessellate(Capsule{capsule.radius, axis.norm()}));
      body.X_WB = X_WL[capsule.link] * MakeTransform(FrameFromNormal(axis.normalized()),
                                                     0.5 * (capsule.p_LA + capsule.p_LB));
      body.color = {0.9F, 0.4F, 0.1F, 0.35F};
      body.shading = Shading::kGhost;
      scene.bodies.push_back(body);
    }
  }
  MatrixX3 corners(0, 3);
  for (const RenderBody& body : scene.bodies) {
    const Eigen::Index at = corners.rows();
    corners.conservativeResize(at + body.mesh->V.rows(), 3);
    for (Eigen::Index i = 0; i < body.mesh->V.rows(); ++i) {
      corners.row(at + i) = body.X_WB * Vector3(body.mesh->V.row(i).transpose());
    }
  }
  scene.camera = FrameCamera(corners, pose.dir_H.normalized(), 4.0 / 3.0);
  scene.axes = false;
  return scene;
}

}  // namespace
}  // namespace pregrasp

int main(int argc, char** argv) {
  using namespace pregrasp;
  if (argc != 2) {
    std::fputs("usage: hand_pictures DIRECTORY\n", stderr);
    return 2;
  }
  const std::filesystem::path directory = argv[1];
  std::filesystem::create_directories(directory);
  Renderer renderer;
  RenderConfig config;
  config.width = 800;
  config.height = 600;
  config.quality = RenderQuality::kStill;
  for (const Pose& pose : Poses()) {
    WritePng(renderer.Render(MakeScene(pose, false), config),
             directory / (std::string(pose.name) + ".png"));
  }
  WritePng(renderer.Render(MakeScene(Poses().front(), true), config), directory / "capsules.png");
  return 0;
}
