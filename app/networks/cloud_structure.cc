#include "app/networks/cloud_structure.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "app/core/check.h"

namespace pregrasp {
namespace {

// A strict order of points by coordinates, then index; the index decides only between equal points.
struct ByCoordinates {
  const MatrixX3& P;
  bool operator()(int a, int b) const {
    for (int axis = 0; axis < 3; ++axis) {
      if (P(a, axis) != P(b, axis)) return P(a, axis) < P(b, axis);
    }
    return a < b;
  }
};

std::vector<int> SampleFarthestPoints(const MatrixX3& P, int count) {
  const int n = static_cast<int>(P.rows());
  const ByCoordinates before{P};
  int next = 0;
  for (int i = 1; i < n; ++i) {
    if (before(i, next)) next = i;
  }
  std::vector<int> chosen;
  VectorX distance2 = VectorX::Constant(n, std::numeric_limits<double>::infinity());
  while (static_cast<int>(chosen.size()) < count) {
    chosen.push_back(next);
    distance2[next] = -1.0;  // never again, even where points coincide
    int best = -1;
    for (int i = 0; i < n; ++i) {
      if (distance2[i] < 0.0) continue;
      distance2[i] = std::min(distance2[i], (P.row(i) - P.row(chosen.back())).squaredNorm());
      if (best < 0 || distance2[i] > distance2[best] ||
          (distance2[i] == distance2[best] && before(i, best))) {
        best = i;
      }
    }
    next = best;
  }
  return chosen;
}

SetLevel BuildLevel(const MatrixX3& P, const SetLevelConfig& config) {
  const ByCoordinates before{P};
  SetLevel level;
  level.centroids = SampleFarthestPoints(P, config.centroids);
  level.begin.push_back(0);
  for (const int centroid : level.centroids) {
    std::vector<std::pair<double, int>> near;
    for (int i = 0; i < P.rows(); ++i) {
      const double distance2 = (P.row(i) - P.row(centroid)).squaredNorm();
      if (i == centroid || distance2 <= config.radius * config.radius)
        near.emplace_back(distance2, i);
    }
    std::sort(near.begin(), near.end(), [&](const auto& a, const auto& b) {
      return a.first != b.first ? a.first < b.first : before(a.second, b.second);
    });
    near.resize(std::min<std::size_t>(near.size(), config.neighbors));
    for (const auto& [distance2, i] : near) level.neighbors.push_back(i);
    level.begin.push_back(static_cast<int>(level.neighbors.size()));
  }
  return level;
}

}  // namespace

Matrix3 CloudStructure::CalcUprightFrame(const Vector3& up_O) const {
  const Vector3 u = R_WO0 * up_O;
  const double c = u.z();
  Matrix3 R;
  if (c < -1.0 + 1e-9) {
    R = Vector3(1.0, -1.0, -1.0).asDiagonal();
  } else {
    // Rodrigues' formula about u x z, whose length is the angle's sine.
    const double x = u.y(), y = -u.x(), k = 1.0 / (1.0 + c);
    R << c + k * x * x, k * x * y, y, k * x * y, c + k * y * y, -x, -y, x, c;
  }
  return R * R_WO0;
}

CloudStructure BuildCloudStructure(const MatrixX3& P_O, const Matrix3& R_WO0,
                                   const std::vector<SetLevelConfig>& levels) {
  CloudStructure structure;
  structure.P_O = P_O;
  structure.p_OC = 0.5 * (P_O.colwise().minCoeff() + P_O.colwise().maxCoeff()).transpose();
  structure.R_WO0 = R_WO0;
  MatrixX3 P = P_O;
  for (const SetLevelConfig& config : levels) {
    PREGRASP_CHECK(config.centroids >= 1 && config.centroids <= P.rows(), config.centroids,
                   P.rows());
    structure.levels.push_back(BuildLevel(P, config));
    const std::vector<int>& centroids = structure.levels.back().centroids;
    P = MatrixX3(P(centroids, Eigen::all));
  }
  return structure;
}

}  // namespace pregrasp
