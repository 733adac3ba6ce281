#include "app/geometry/cloud_planes.h"

#include <algorithm>
#include <cmath>

#include "app/core/interrupt.h"
#include "app/geometry/point_index.h"

namespace pregrasp {
namespace {

// A point's neighbourhood, itself first, and weights that fall off from it.
struct Neighbourhood {
  MatrixX3 Q;
  VectorX weight;

  Neighbourhood(const SampledCloud& cloud, int i)
      : Q(kCloudNeighbours + 1, 3), weight(kCloudNeighbours + 1) {
    Q.row(0) = cloud.P.row(i);
    for (int k = 0; k < kCloudNeighbours; ++k) Q.row(k + 1) = cloud.P.row(cloud.near[i][k]);
    const double reach = (Q.row(kCloudNeighbours / 2) - Q.row(0)).squaredNorm();
    for (int k = 0; k <= kCloudNeighbours; ++k) {
      weight[k] = std::exp(-(Q.row(k) - Q.row(0)).squaredNorm() / reach);
    }
  }

  // Weights less for points off the plane through the first one.
  VectorX Support(const Vector3& nhat, double near) const {
    const VectorX height = (Q.rowwise() - Q.row(0)) * nhat;
    return weight.array() * (-(height / near).array().square()).exp();
  }

  Vector3 FitNormal(const VectorX& w) const {
    const Vector3 mean = (Q.transpose() * w) / w.sum();
    const MatrixX3 D = Q.rowwise() - mean.transpose();
    const Matrix3 spread = D.transpose() * w.asDiagonal() * D;
    return Eigen::SelfAdjointEigenSolver<Matrix3>(spread).eigenvectors().col(0);
  }

  // Of the fitted plane and planes through the point and two near neighbours, the one that has most
  // support.
  Vector3 FindNormal(double near) const {
    Vector3 best = FitNormal(weight);
    double most = Support(best, near).sum();
    for (int j = 1; j <= kCloudNeighbours / 2; ++j) {
      for (int k = j + 1; k <= kCloudNeighbours / 2; ++k) {
        const Vector3 u = Q.row(j) - Q.row(0), v = Q.row(k) - Q.row(0);
        const Vector3 cross = u.cross(v);
        if (cross.norm() < 0.3 * u.norm() * v.norm()) continue;
        const double sum = Support(cross.normalized(), near).sum();
        if (sum > most) {
          most = sum;
          best = cross.normalized();
        }
      }
    }
    return FitNormal(Support(best, near));
  }
};

// How near to its plane a point counts as on it: the least at which most points find a plane that
// also holds a good part of the farther neighbours, which did not choose it; so it follows noise
// and curvature, but not walls.
double FindNearness(const SampledCloud& cloud) {
  const int n = static_cast<int>(cloud.P.rows());
  const int step = std::max(1, n / 400);
  double near = 0.06 * cloud.spacing;
  while (near < 0.4 * cloud.spacing) {
    std::vector<double> shares;
    for (int i = 0; i < n; i += step) {
      ThrowIfInterrupted();
      const Neighbourhood around(cloud, i);
      const VectorX far = around.Support(around.FindNormal(near), near).tail(kCloudNeighbours / 2);
      shares.push_back(far.sum() / around.weight.tail(kCloudNeighbours / 2).sum());
    }
    if (Percentile(shares, 0.3) > 0.35) break;
    near *= 2.0;
  }
  return near;
}

}  // namespace

MatrixX3 TakeRows(const MatrixX3& M, const std::vector<int>& rows) {
  MatrixX3 result(static_cast<int>(rows.size()), 3);
  for (std::size_t i = 0; i < rows.size(); ++i) result.row(static_cast<int>(i)) = M.row(rows[i]);
  return result;
}

double Percentile(std::vector<double> values, double share) {
  const auto k = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(k), values.end());
  return values[k];
}

void FindNeighbourhoods(SampledCloud& cloud) {
  const int n = static_cast<int>(cloud.P.rows());
  cloud.bounds = {Vector3(cloud.P.colwise().minCoeff()), Vector3(cloud.P.colwise().maxCoeff())};
  const Vector3 size = cloud.bounds.sizes();
  // About the spacing of n points on the bounds' surface.
  const double area = 2.0 * (size.x() * size.y() + size.y() * size.z() + size.z() * size.x());
  const PointIndex index(cloud.P, std::max(2.0 * std::sqrt(area / n), 1e-9));
  std::vector<int> found;
  std::vector<double> nearest, sixth;
  cloud.near.resize(n);
  for (int i = 0; i < n; ++i) {
    ThrowIfInterrupted();
    const Vector3 p = cloud.P.row(i);
    index.FindNearest(p, kCloudNeighbours + 1, found);
    found.erase(std::find(found.begin(), found.end(), i));
    std::copy(found.begin(), found.end(), cloud.near[i].begin());
    const auto distance = [&](int k) { return (cloud.P.row(found[k]).transpose() - p).norm(); };
    nearest.push_back((distance(0) + distance(1) + distance(2) + distance(3)) / 4.0);
    sixth.push_back(distance(5));
  }
  cloud.spacing = Percentile(nearest, 0.5);
  cloud.widest = Percentile(sixth, 0.98);
  cloud.near_plane = FindNearness(cloud);
}

void FitPlanes(SampledCloud& cloud) {
  cloud.N.resize(cloud.P.rows(), 3);
  for (int i = 0; i < cloud.P.rows(); ++i) {
    ThrowIfInterrupted();
    cloud.N.row(i) = Neighbourhood(cloud, i).FindNormal(cloud.near_plane).transpose();
  }
}

void DropStrays(SampledCloud& cloud) {
  std::vector<int> kept;
  for (int i = 0; i < cloud.P.rows(); ++i) {
    int alike = 0;
    for (int k = 0; k < kCloudNeighbours / 2; ++k) {
      if (cloud.N.row(i).dot(cloud.N.row(cloud.near[i][k])) > 0.8) ++alike;
    }
    if (alike >= 2) kept.push_back(i);
  }
  if (2 * std::ssize(kept) < cloud.P.rows()) return;
  cloud.P = TakeRows(cloud.P, kept);
  cloud.N = TakeRows(cloud.N, kept);
}

}  // namespace pregrasp
