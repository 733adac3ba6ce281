#include "app/pictures/camera.h"

#include <cmath>

#include "render/upright.h"

namespace pregrasp {
namespace {

// A small piece of the object's surface.
struct Patch {
  Vector3 p_W, nhat_W;
  double area = 0.0;
};

// Four patches a triangle: its middle, and one towards each corner.
std::vector<Patch> MakePatches(const TriangleMesh& mesh) {
  std::vector<Patch> patches;
  for (Eigen::Index f = 0; f < mesh.F.rows(); ++f) {
    const Vector3 a = mesh.V.row(mesh.F(f, 0)), b = mesh.V.row(mesh.F(f, 1)),
                  c = mesh.V.row(mesh.F(f, 2));
    const Vector3 normal = (b - a).cross(c - a);
    const double area = 0.5 * normal.norm();
    if (area <= 0.0) continue;
    const Vector3 middle = (a + b + c) / 3.0;
    for (const Vector3& p : {middle, Vector3(0.3 * middle + 0.7 * a),
                             Vector3(0.3 * middle + 0.7 * b), Vector3(0.3 * middle + 0.7 * c)}) {
      patches.push_back({p, normal.normalized(), 0.25 * area});
    }
  }
  return patches;
}

// Whether the way from p_W along dir_W is free for a metre, by sphere tracing.
bool IsFree(const Vector3& p_W, const Vector3& dir_W, const EnvironmentDistance& environment) {
  constexpr double kReach = 1.0, kHit = 5e-4;  // [m]
  constexpr int kMostSteps = 60;
  double way = 2.0 * kHit;
  for (int i = 0; i < kMostSteps && way < kReach; ++i) {
    const double phi = environment.Calc(p_W + way * dir_W).phi;
    if (phi < 0.5 * kHit) return false;
    way += std::max(phi, kHit);
  }
  return true;
}

double VisibleShare(const std::vector<Patch>& patches, const Vector3& dir_W,
                    const EnvironmentDistance& environment) {
  double seen = 0.0, all = 1e-300;
  for (const Patch& patch : patches) {
    const double weight = patch.area * std::max(0.0, patch.nhat_W.dot(dir_W));
    if (weight <= 0.0) continue;
    all += weight;
    if (IsFree(patch.p_W + 1e-3 * patch.nhat_W, dir_W, environment)) seen += weight;
  }
  return seen / all;
}

}  // namespace

Vector3 ChooseViewDirection(const TriangleMesh& mesh_W, const EnvironmentDistance& environment,
                            const Vector3& up_W) {
  constexpr double kAsGood = 0.03;  // of the visible share
  constexpr double kAzimuths_deg[] = {-60, -120, -20, -160, 30, 150, 75, 105};
  constexpr double kElevations_deg[] = {28, 45};
  std::vector<Patch> patches = MakePatches(mesh_W);
  constexpr std::size_t kEnough = 600;
  if (patches.size() > kEnough) {  // every n-th one, evenly over the list
    std::vector<Patch> some;
    for (std::size_t i = 0; i < kEnough; ++i) some.push_back(patches[i * patches.size() / kEnough]);
    patches = std::move(some);
  }
  const Matrix3 R_WU = UprightRotation(up_W).transpose();
  Vector3 best = up_W;
  double best_share = -1.0;
  for (const double elevation_deg : kElevations_deg) {
    for (const double azimuth_deg : kAzimuths_deg) {
      const double azimuth = DegToRad(azimuth_deg), elevation = DegToRad(elevation_deg);
      const Vector3 dir_W =
          R_WU * Vector3(std::cos(azimuth) * std::cos(elevation),
                         std::sin(azimuth) * std::cos(elevation), std::sin(elevation));
      const double share = VisibleShare(patches, dir_W, environment);
      if (share > best_share + kAsGood) {
        best_share = share;
        best = dir_W;
      }
    }
  }
  return best;
}

bool IsInSight(const RenderCamera& camera, const MatrixX3& P_W, double aspect, double border) {
  const Vector3 forward_W = (camera.p_WTarget - camera.p_WCam).normalized();
  const Vector3 side_W = forward_W.cross(Vector3::UnitZ());
  if (side_W.norm() < 1e-6) return false;  // straight down: framed anew
  const Vector3 right_W = side_W.normalized();
  const Vector3 up_W = right_W.cross(forward_W);
  const double half_height = (1.0 - border) * std::tan(0.5 * DegToRad(camera.fov_deg));
  for (Eigen::Index i = 0; i < P_W.rows(); ++i) {
    const Vector3 d_W = P_W.row(i).transpose() - camera.p_WCam;
    const double depth = d_W.dot(forward_W);
    if (depth <= 0.0 || std::abs(d_W.dot(up_W)) > half_height * depth ||
        std::abs(d_W.dot(right_W)) > half_height * aspect * depth) {
      return false;
    }
  }
  return true;
}

MatrixX3 FindOutermost(const MatrixX3& P) {
  MatrixX3 outermost(26, 3);
  Eigen::Index count = 0;
  for (int i = 0; i < 27; ++i) {
    const Vector3 direction(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    if (direction.isZero()) continue;
    Eigen::Index at = 0;
    (P * direction).maxCoeff(&at);
    outermost.row(count++) = P.row(at);
  }
  return outermost;
}

MatrixX3 FocusAround(const MatrixX3& P_W, double share, double headroom) {
  Vector3 low = P_W.colwise().minCoeff(), high = P_W.colwise().maxCoeff();
  const double longest = (high - low).maxCoeff();
  low.array() -= share * longest;
  high.array() += share * longest;
  high.z() += headroom;
  MatrixX3 corners(8, 3);
  for (int i = 0; i < 8; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      corners(i, axis) = (i >> axis) & 1 ? high[axis] : low[axis];
    }
  }
  return corners;
}

}  // namespace pregrasp
