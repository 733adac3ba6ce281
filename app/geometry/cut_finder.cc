#include "app/geometry/cut_finder.h"

#include <algorithm>
#include <cmath>

#include "app/core/rng.h"
#include "app/geometry/mesh_topology.h"
#include "app/geometry/triangle_samples.h"

namespace pregrasp {
namespace {

constexpr int kSamples = 700;           // surface points of a piece that judge where to cut
constexpr int kPairs = 1500;            // pairs of them
constexpr double kNatural = 0.5;        // what an edge that turns inward is worth
constexpr double kSmallestSide = 0.01;  // share of a piece's samples on either side of a cut

MatrixX3 SampleSurface(const std::vector<SolidPart>& parts, Rng& rng) {
  std::vector<double> sums;
  std::vector<const Triangle*> triangles;
  double sum = 0.0;
  for (const SolidPart& part : parts) {
    for (const Triangle& t : part.surface) {
      sums.push_back(sum += AreaOf(t));
      triangles.push_back(&t);
    }
  }
  MatrixX3 P(kSamples, 3);
  int next = 0;
  VisitSamples(
      sums, kSamples, rng, [&](int i) { return *triangles[i]; },
      [&](const Vector3& p) { P.row(next++) = p.transpose(); });
  return P;
}

}  // namespace

// The longest and sharpest edges come first.
void CutFinder::FindReflexPlanes() {
  struct Reflex {
    double weight;
    int face, neighbour;
    Vector3 p;
  };
  std::vector<Reflex> edges;
  const auto neighbours = FindNeighbours(mesh_);
  std::vector<Vector3> normals(mesh_.F.rows());
  for (int f = 0; f < mesh_.F.rows(); ++f) {
    const Triangle t = FaceOf(mesh_, f);
    normals[f] = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
  }
  constexpr double kSinSharp = 0.1;
  for (int f = 0; f < mesh_.F.rows(); ++f) {
    const Triangle t = FaceOf(mesh_, f);
    for (int i = 0; i < 3; ++i) {
      const int g = neighbours[f][i];
      if (g < f) continue;
      const Vector3 edge = t[(i + 1) % 3] - t[i];
      const double turn = normals[f].cross(normals[g]).dot(edge);  // below 0 where it is reflex
      if (turn < -kSinSharp * edge.norm()) edges.push_back({turn, f, g, t[i] + 0.5 * edge});
    }
  }
  std::stable_sort(edges.begin(), edges.end(),
                   [](const Reflex& a, const Reflex& b) { return a.weight < b.weight; });
  constexpr std::size_t kMaxPlanes = 96;
  for (const Reflex& edge : edges) {
    if (reflex_planes_.size() >= kMaxPlanes) break;
    const Vector3& n = normals[edge.face];
    const Vector3& m = normals[edge.neighbour];
    for (const Vector3& nhat : {n, m, Vector3((n - m).normalized())}) {
      AddReflexPlane({nhat, nhat.dot(edge.p)});
    }
  }
}

void CutFinder::AddReflexPlane(const Plane& plane) {
  if (!plane.nhat.allFinite()) return;
  for (const Plane& other : reflex_planes_) {
    const double along = other.nhat.dot(plane.nhat);
    const double apart = other.offset - std::copysign(1.0, along) * plane.offset;
    if (std::abs(along) > 0.9995 && std::abs(apart) < 0.005 * size_) return;
  }
  reflex_planes_.push_back(plane);
}

std::vector<CutFinder::Pair> CutFinder::FindPairs(const MatrixX3& P, Rng& rng) const {
  std::vector<Pair> pairs;
  for (int k = 0; k < kPairs; ++k) {
    const int i = static_cast<int>(rng.UniformInt(kSamples));
    const int j = static_cast<int>(rng.UniformInt(kSamples));
    double farthest = 0.0;
    for (const double s : {0.25, 0.5, 0.75}) {
      const Vector3 p = (1.0 - s) * P.row(i) + s * P.row(j);
      farthest = std::max(farthest, roughly_.CalcRoughly(p));
    }
    if (farthest > 0.0) pairs.push_back({i, j, farthest * farthest});
  }
  return pairs;
}

// Those at reflex edges, and across axes that may suit the piece.
std::vector<Plane> CutFinder::ListPlanes(const MatrixX3& P) const {
  const Vector3 mean = P.colwise().mean();
  const MatrixX3 centred = P.rowwise() - mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Matrix3> axes(centred.transpose() * centred);
  std::vector<Vector3> directions{Vector3::UnitX(), Vector3::UnitY(), Vector3::UnitZ()};
  for (int k = 0; k < 3; ++k) directions.emplace_back(axes.eigenvectors().col(k));
  for (int k = 0; k < 3; ++k) {
    const Vector3 u = directions[3 + (k + 1) % 3], v = directions[3 + (k + 2) % 3];
    directions.emplace_back((u + v).normalized());
    directions.emplace_back((u - v).normalized());
  }
  std::vector<Plane> planes = reflex_planes_;
  constexpr int kAcross = 9;
  for (const Vector3& nhat : directions) {
    const VectorX heights = P * nhat;
    const double low = heights.minCoeff(), high = heights.maxCoeff();
    for (int i = 1; i <= kAcross; ++i) {
      planes.push_back({nhat, low + (high - low) * i / (kAcross + 1)});
    }
    planes.push_back({nhat, nhat.dot(mean)});
  }
  return planes;
}

std::vector<Cut> CutFinder::Find(const std::vector<SolidPart>& parts) const {
  Rng rng(0, RngStream::kMeshCuts);
  const MatrixX3 P = SampleSurface(parts, rng);
  const std::vector<Pair> pairs = FindPairs(P, rng);
  double total = 0.0;
  for (const Pair& pair : pairs) total += pair.energy;
  std::vector<Cut> cuts;
  std::vector<bool> above(kSamples);
  const std::vector<Plane> planes = ListPlanes(P);
  for (std::size_t k = 0; k < planes.size(); ++k) {
    const Plane& plane = planes[k];
    const VectorX heights = P * plane.nhat;
    int count = 0;
    for (int i = 0; i < kSamples; ++i) {
      above[i] = heights[i] > plane.offset;
      count += above[i] ? 1 : 0;
    }
    if (count < kSmallestSide * kSamples || count > (1.0 - kSmallestSide) * kSamples) continue;
    // Among cuts that do about the same, the most even one.
    double energy = 0.02 * total * std::abs(2.0 * count / kSamples - 1.0);
    for (const Pair& pair : pairs) {
      if (above[pair.i] == above[pair.j]) energy += pair.energy;
    }
    // Natural cuts leave whole what is convex, others have to be joined again.
    if (k < reflex_planes_.size()) energy *= kNatural;
    cuts.push_back({plane, energy});
  }
  std::stable_sort(cuts.begin(), cuts.end(),
                   [](const Cut& a, const Cut& b) { return a.energy < b.energy; });
  return cuts;
}

}  // namespace pregrasp
