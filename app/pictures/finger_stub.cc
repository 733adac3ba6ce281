#include "app/pictures/finger_stub.h"

#include <cmath>
#include <map>
#include <memory>
#include <mutex>

#include "app/geometry/tessellate.h"
#include "render/palette.h"

namespace pregrasp {
namespace {

constexpr double kDistalLength = 0.024, kMiddleLength = 0.034;  // [m], about those of a hand
constexpr double kTaper = 0.88;                                 // of the radius, link by link

// The links' meshes, one set a radius, shared by all pictures of the process.
struct StubMeshes {
  std::shared_ptr<const TriangleMesh> tip, distal, middle;
};

StubMeshes MeshesOf(double radius) {
  static std::mutex mutex;
  static std::map<double, StubMeshes> known;
  const std::lock_guard lock(mutex);
  StubMeshes& meshes = known[radius];
  if (meshes.tip) return meshes;
  const auto share = [](const Shape& shape) {
    return std::make_shared<const TriangleMesh>(Tessellate(shape, 40));
  };
  meshes = {share(Sphere{radius}), share(Capsule{kTaper * radius, kDistalLength}),
            share(Capsule{kTaper * kTaper * radius, kMiddleLength})};
  return meshes;
}

RigidTransform Link(const Vector3& from_W, const Vector3& dir_W, double length) {
  return MakeTransform(FrameFromNormal(dir_W), from_W + 0.5 * length * dir_W);
}

}  // namespace

std::vector<RenderBody> MakeFingerStub(Finger finger, double radius, const Vector3& p_WC,
                                       const Vector3& nhat_W, const Vector3& to_viewer_W) {
  Vector3 away_W = -(to_viewer_W - to_viewer_W.dot(nhat_W) * nhat_W);
  away_W =
      away_W.norm() > 1e-3 ? Vector3(away_W.normalized()) : Vector3(FrameFromNormal(nhat_W).col(0));
  const auto lean = [&](double angle_deg) {
    const double angle = DegToRad(angle_deg);
    return Vector3(std::cos(angle) * nhat_W + std::sin(angle) * away_W);
  };
  const Vector3 distal_W = lean(28.0), middle_W = lean(62.0);
  const Vector3 p_WTip = p_WC + radius * nhat_W;
  const Vector3 p_WJoint = p_WTip + kDistalLength * distal_W;
  const StubMeshes meshes = MeshesOf(radius);
  std::vector<RenderBody> bodies(3);
  bodies[0].mesh = meshes.tip;
  bodies[0].X_WB.translation() = p_WTip;
  bodies[1].mesh = meshes.distal;
  bodies[1].X_WB = Link(p_WTip, distal_W, kDistalLength);
  bodies[2].mesh = meshes.middle;
  bodies[2].X_WB = Link(p_WJoint, middle_W, kMiddleLength);
  bodies[0] = WithLook(bodies[0], FingerColor(finger), 0.45F);
  bodies[1] = WithLook(bodies[1], HandColor(), 0.55F);
  bodies[2] = WithLook(bodies[2], HandColor(), 0.55F);
  return bodies;
}

}  // namespace pregrasp
