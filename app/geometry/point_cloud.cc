#include "app/geometry/point_cloud.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "app/core/check.h"
#include "app/core/interrupt.h"
#include "app/geometry/signed_distance.h"
#include "app/geometry/tessellate.h"
#include "app/scene/shape_visit.h"

namespace pregrasp {
namespace {

constexpr int kSegments = 96;    // of round parts; the points are then put on the true surface
constexpr int kCandidates = 12;  // for each point wanted
constexpr int kMinCandidates = 4096;
constexpr int kMaxRounds = 64;

// A shape without unions in it, placed in the whole shape's frame.
struct CloudLeaf {
  SignedDistance distance;
  TriangleMesh mesh;  // in its own frame P
  RigidTransform X_BP;
};

// Draws points on all leaves by area, puts them on the true surfaces, and leaves out those that
// another part covers.
class Candidates {
 public:
  explicit Candidates(const Shape& shape) : distance_(shape) {
    ForEachLeaf(shape, RigidTransform::Identity(), [&](const Shape& leaf, const RigidTransform& X) {
      leaves_.push_back({SignedDistance(leaf), Tessellate(leaf, kSegments), X});
    });
    double sum = 0.0;
    for (std::size_t l = 0; l < leaves_.size(); ++l) {
      const TriangleMesh& mesh = leaves_[l].mesh;
      for (int f = 0; f < mesh.F.rows(); ++f) {
        const Vector3 a = mesh.V.row(mesh.F(f, 0)), b = mesh.V.row(mesh.F(f, 1)),
                      c = mesh.V.row(mesh.F(f, 2));
        sums_.push_back(sum += (b - a).cross(c - a).norm());
        faces_.emplace_back(static_cast<int>(l), f);
      }
    }
  }

  void Draw(int count, Rng& rng) {
    for (int i = 0; i < count; ++i) {
      ThrowIfInterrupted();
      const double at = (i + rng.Uniform()) / count * sums_.back();
      const auto it = std::lower_bound(sums_.begin(), sums_.end() - 1, at);
      const auto [l, f] = faces_[it - sums_.begin()];
      const CloudLeaf& leaf = leaves_[l];
      const TriangleMesh& mesh = leaf.mesh;
      const double s = std::sqrt(rng.Uniform()), t = rng.Uniform();
      const Vector3 q_P = (1.0 - s) * mesh.V.row(mesh.F(f, 0)) +
                          s * (1.0 - t) * mesh.V.row(mesh.F(f, 1)) +
                          s * t * mesh.V.row(mesh.F(f, 2));
      Vector3 nhat_P;
      const Vector3 p_P = leaf.distance.Project(q_P, &nhat_P);
      const Vector3 p_B = leaf.X_BP * p_P, nhat_B = leaf.X_BP.linear() * nhat_P;
      // A step outward must leave the whole shape: not so inside another part, nor where two parts
      // lie flush.
      constexpr double kStep = 1e-6;  // [m]
      if (leaves_.size() > 1 && distance_.Calc(p_B + kStep * nhat_B) < 0.5 * kStep) continue;
      points.push_back(p_B);
      normals.push_back(nhat_B);
    }
  }

  std::vector<Vector3> points, normals;

 private:
  SignedDistance distance_;
  std::vector<CloudLeaf> leaves_;
  std::vector<double> sums_;                // running areas
  std::vector<std::pair<int, int>> faces_;  // (leaf, face)
};

// Indices of `count` of the points: the first, then always the one farthest from those chosen.
std::vector<int> ThinByFarthest(const std::vector<Vector3>& points, int count) {
  const auto n = static_cast<int>(points.size());
  std::vector<double> x(n), y(n), z(n), nearest(n, std::numeric_limits<double>::infinity());
  for (int i = 0; i < n; ++i) {
    x[i] = points[i].x();
    y[i] = points[i].y();
    z[i] = points[i].z();
  }
  std::vector<int> chosen;
  chosen.reserve(count);
  int next = 0;
  while (static_cast<int>(chosen.size()) < count) {
    ThrowIfInterrupted();
    chosen.push_back(next);
    const double cx = x[next], cy = y[next], cz = z[next];
    for (int i = 0; i < n; ++i) {
      const double dx = x[i] - cx, dy = y[i] - cy, dz = z[i] - cz;
      nearest[i] = std::min(nearest[i], dx * dx + dy * dy + dz * dz);
    }
    next = static_cast<int>(std::max_element(nearest.begin(), nearest.end()) - nearest.begin());
  }
  return chosen;
}

}  // namespace

PointCloud SamplePointCloud(const Shape& shape, int count, Rng rng) {
  PREGRASP_CHECK(count > 0, count);
  Candidates candidates(shape);
  const int wanted = std::max(kMinCandidates, kCandidates * count);
  for (int round = 0; round < kMaxRounds; ++round) {
    candidates.Draw(wanted, rng);
    if (static_cast<int>(candidates.points.size()) >= wanted / 2) break;
  }
  PREGRASP_CHECK(static_cast<int>(candidates.points.size()) >= count, candidates.points.size());
  const std::vector<int> chosen = ThinByFarthest(candidates.points, count);
  PointCloud cloud;
  cloud.P.resize(count, 3);
  cloud.N.resize(count, 3);
  for (int i = 0; i < count; ++i) {
    cloud.P.row(i) = candidates.points[chosen[i]].transpose();
    cloud.N.row(i) = candidates.normals[chosen[i]].transpose();
  }
  return cloud;
}

}  // namespace pregrasp
