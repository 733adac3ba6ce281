#include "app/geometry/revolution.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "app/geometry/bounds.h"

namespace pregrasp {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

// Sine of the angle between a normal and the plane through the axis. The facets of a coarse
// polygon (16 sides) have up to 0.07.
constexpr double kAgrees = 0.15;
constexpr double kWeightScale = 0.05;
constexpr int kRounds = 20;

struct Facet {
  Vector3 p, nhat;  // p about the mean, over the mesh's size
  double area = 0.0;
};

struct Line {
  Vector3 p, direction;
};

// How far the rotation about `line` leaves the facet's plane, over its speed there.
double CalcResidual(const Line& line, const Facet& facet) {
  const Vector3 v = line.direction.cross(facet.p - line.p);
  const double speed = v.norm();
  return speed > 1e-3 ? std::abs(v.dot(facet.nhat)) / speed : 0.0;
}

// The line that minimises the sum of (v . nhat)^2 for v = c + w x p, |w| = 1; `rank` 0 is the least
// of the three stationary ones.
Line FitLine(const std::vector<Facet>& facets, const std::vector<double>& weights, int rank) {
  Matrix6 M = Matrix6::Zero();
  for (std::size_t f = 0; f < facets.size(); ++f) {
    Vector6 row;
    row << facets[f].nhat, facets[f].p.cross(facets[f].nhat);
    M += weights[f] * row * row.transpose();
  }
  // A flat surface leaves some of c open; then the least c is taken.
  const Matrix3 A = M.topLeftCorner<3, 3>() + 1e-9 * M.trace() * Matrix3::Identity();
  const Matrix3 c_of_w = -A.inverse() * M.topRightCorner<3, 3>();
  const Matrix3 S = M.bottomRightCorner<3, 3>() + M.bottomLeftCorner<3, 3>() * c_of_w;
  const Eigen::SelfAdjointEigenSolver<Matrix3> solver(0.5 * (S + S.transpose()));
  const Vector3 w = solver.eigenvectors().col(rank);
  return {w.cross(c_of_w * w), w};
}

Line Refine(const std::vector<Facet>& facets, int rank) {
  std::vector<double> weights;
  weights.reserve(facets.size());
  for (const Facet& facet : facets) weights.push_back(facet.area);
  Line line = FitLine(facets, weights, rank);
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t f = 0; f < facets.size(); ++f) {
      const double r = CalcResidual(line, facets[f]) / kWeightScale;
      weights[f] = facets[f].area / ((1.0 + r * r) * (1.0 + r * r));
    }
    const Line last = line;
    line = FitLine(facets, weights, 0);
    if (last.direction.cross(line.direction).norm() < 1e-9 && (last.p - line.p).norm() < 1e-9)
      break;
  }
  return line;
}

// Share of the surface that agrees, by area times how far it faces away from the axis.
double CalcAgreement(const Line& line, const std::vector<Facet>& facets) {
  double agrees = 0.0, all = 0.0;
  for (const Facet& facet : facets) {
    const double evidence = facet.area * facet.nhat.cross(line.direction).norm();
    all += evidence;
    if (CalcResidual(line, facet) < kAgrees) agrees += evidence;
  }
  return all > 0.0 ? agrees / all : 0.0;
}

// Across the axis, to the surface that does not agree; where there is none, to the farthest corner.
Vector3 FindDirection(const Line& line, const std::vector<Facet>& facets, const TriangleMesh& mesh,
                      const Vector3& p_B) {
  Vector3 sum = Vector3::Zero();
  double odd = 0.0, all = 0.0;
  for (const Facet& facet : facets) {
    all += facet.area;
    if (CalcResidual(line, facet) < kAgrees) continue;
    const Vector3 r = facet.p - line.p;
    sum += facet.area * (r - r.dot(line.direction) * line.direction);
    odd += facet.area;
  }
  if (odd > 0.01 * all && sum.norm() > 0.1 * odd) return sum.normalized();
  Vector3 farthest = line.direction.unitOrthogonal();
  double best = 0.0;
  for (int v = 0; v < mesh.V.rows(); ++v) {
    const Vector3 r = mesh.V.row(v).transpose() - p_B;
    const Vector3 across = r - r.dot(line.direction) * line.direction;
    if (across.norm() > best * (1.0 + 1e-9)) {
      best = across.norm();
      farthest = across / best;
    }
  }
  return farthest;
}

// The number of directions from the axis in which corners lie, if they are evenly spread and
// `towards` is one of them.
int CountSides(const Revolution& revolution, const TriangleMesh& mesh) {
  constexpr int kMaxSides = 360;
  constexpr double kSame = 2e-3;  // [rad]
  std::vector<double> angles;
  const Vector3 side = revolution.axis.cross(revolution.towards);
  const double size = (mesh.V.colwise().maxCoeff() - mesh.V.colwise().minCoeff()).norm();
  for (int v = 0; v < mesh.V.rows(); ++v) {
    const Vector3 r = mesh.V.row(v).transpose() - revolution.p_B;
    const double x = r.dot(revolution.towards), y = r.dot(side);
    if (std::hypot(x, y) < 0.02 * size) continue;
    const double angle = std::atan2(y, x);
    angles.push_back(angle < -kSame ? angle + 2.0 * kPi : angle);
  }
  std::sort(angles.begin(), angles.end());
  int count = 0;
  double last = -1.0;
  for (const double angle : angles) {
    if (angle - last > kSame) ++count;
    last = angle;
    if (count > kMaxSides) return 0;
  }
  for (const double angle : angles) {
    const double turns = angle * count / (2.0 * kPi);
    if (std::abs(turns - std::round(turns)) > kSame * count) return 0;
  }
  return count;
}

}  // namespace

std::optional<Revolution> FindRevolution(const TriangleMesh& mesh, double share) {
  const Vector3 low = mesh.V.colwise().minCoeff(), high = mesh.V.colwise().maxCoeff();
  const Vector3 center = 0.5 * (low + high);
  const double size = (high - low).norm();
  // An even share of the facets of a large mesh is enough.
  constexpr int kMaxFacets = 6000;
  const int stride = 1 + static_cast<int>(mesh.F.rows()) / kMaxFacets;
  std::vector<Facet> facets;
  for (int f = 0; f < mesh.F.rows(); f += stride) {
    const Vector3 a = mesh.V.row(mesh.F(f, 0)), b = mesh.V.row(mesh.F(f, 1)),
                  c = mesh.V.row(mesh.F(f, 2));
    const Vector3 cross = (b - a).cross(c - a);
    if (!(cross.norm() > 0.0)) continue;
    facets.push_back({((a + b + c) / 3.0 - center) / size, cross.normalized(),
                      0.5 * cross.norm() / (size * size)});
  }
  Line best;
  double agreement = 0.0;
  for (int rank = 0; rank < 3; ++rank) {
    const Line line = Refine(facets, rank);
    const double agrees = CalcAgreement(line, facets);
    if (agrees > agreement + 1e-6) {
      agreement = agrees;
      best = line;
    }
  }
  if (agreement < share) return std::nullopt;
  // About an axis outside, sectors would be cuts through a bent bar that goes round it in part.
  const AlignedBox bounds(low, high);
  if (!bounds.contains(Vector3(center + size * best.p))) return std::nullopt;
  Revolution revolution;
  revolution.axis = best.direction;
  revolution.p_B = center + size * best.p;
  revolution.towards = FindDirection(best, facets, mesh, revolution.p_B);
  revolution.sides = CountSides(revolution, mesh);
  return revolution;
}

}  // namespace pregrasp
