#include "app/training/object_similarity.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pregrasp {
namespace {

// Centred, in its principal axes, largest spread first.
MatrixX3 Align(const MatrixX3& P) {
  const MatrixX3 centred = P.rowwise() - P.colwise().mean();
  const Matrix3 covariance = centred.transpose() * centred;
  const Eigen::SelfAdjointEigenSolver<Matrix3> solver(covariance);
  Matrix3 axes = solver.eigenvectors().rowwise().reverse();
  if (axes.determinant() < 0.0) axes.col(2) = -axes.col(2);
  return centred * axes;
}

double MeanDistance(const MatrixX3& P, const MatrixX3& Q) {
  double sum = 0.0;
  for (int i = 0; i < P.rows(); ++i) {
    sum += std::sqrt((Q.rowwise() - P.row(i)).rowwise().squaredNorm().minCoeff());
  }
  return sum / static_cast<double>(P.rows());
}

}  // namespace

double CalcAlignedChamfer(const MatrixX3& P, const MatrixX3& Q) {
  const MatrixX3 a = Align(P), b = Align(Q);
  double best = std::numeric_limits<double>::infinity();
  for (int x = 0; x < 3; ++x) {
    for (int y = 0; y < 3; ++y) {
      if (x == y) continue;
      for (const double sx : {1.0, -1.0}) {
        for (const double sy : {1.0, -1.0}) {
          Matrix3 R = Matrix3::Zero();
          R(0, x) = sx;
          R(1, y) = sy;
          R.row(2) = R.row(0).cross(R.row(1));
          const MatrixX3 turned = b * R.transpose();
          best = std::min(best, 0.5 * (MeanDistance(a, turned) + MeanDistance(turned, a)));
        }
      }
    }
  }
  return best;
}

}  // namespace pregrasp
