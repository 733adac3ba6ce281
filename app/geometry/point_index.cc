#include "app/geometry/point_index.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/core/check.h"

namespace pregrasp {

PointIndex::PointIndex(const MatrixX3& points, double cell) : points_(points), cell_(cell) {
  PREGRASP_CHECK(points.rows() > 0 && cell > 0.0, points.rows(), cell);
  p_min_ = points.colwise().minCoeff();
  const Vector3 size = Vector3(points.colwise().maxCoeff()) - p_min_;
  // No more cells than a few times the points.
  const double most = 4.0 * static_cast<double>(points.rows()) + 64.0;
  const auto cells = [&] { return (size / cell_ + Vector3::Ones()).array().floor().prod(); };
  while (cells() > most) cell_ *= 1.26;
  for (int k = 0; k < 3; ++k) count_[k] = 1 + static_cast<int>(size[k] / cell_);
  const auto id_of = [&](int i) {
    const std::array<int, 3> c = CellOf(points_.row(i));
    return (c[2] * count_[1] + c[1]) * count_[0] + c[0];
  };
  first_.assign(static_cast<std::size_t>(count_[0]) * count_[1] * count_[2] + 1, 0);
  std::vector<int> id(points_.rows());
  for (int i = 0; i < points_.rows(); ++i) ++first_[(id[i] = id_of(i)) + 1];
  for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
  order_.resize(points_.rows());
  std::vector<int> next(first_.begin(), first_.end() - 1);
  for (int i = 0; i < points_.rows(); ++i) order_[next[id[i]]++] = i;
}

std::array<int, 3> PointIndex::CellOf(const Vector3& p) const {
  std::array<int, 3> c{};
  for (int k = 0; k < 3; ++k) {
    c[k] = static_cast<int>(std::clamp(std::floor((p[k] - p_min_[k]) / cell_), 0.0,
                                       static_cast<double>(count_[k] - 1)));
  }
  return c;
}

void PointIndex::FindWithin(const Vector3& p, double radius, std::vector<int>& found) const {
  found.clear();
  const std::array<int, 3> low = CellOf(p - Vector3::Constant(radius));
  const std::array<int, 3> high = CellOf(p + Vector3::Constant(radius));
  for (int z = low[2]; z <= high[2]; ++z) {
    for (int y = low[1]; y <= high[1]; ++y) {
      const int row = (z * count_[1] + y) * count_[0];
      for (int k = first_[row + low[0]]; k < first_[row + high[0] + 1]; ++k) {
        const int i = order_[k];
        if ((points_.row(i).transpose() - p).squaredNorm() <= radius * radius) found.push_back(i);
      }
    }
  }
  std::sort(found.begin(), found.end());
}

void PointIndex::FindNearest(const Vector3& p, int count, std::vector<int>& found) const {
  const int wanted = std::min(count, static_cast<int>(points_.rows()));
  double radius = cell_;
  for (FindWithin(p, radius, found); static_cast<int>(found.size()) < wanted;
       FindWithin(p, radius, found)) {
    radius *= 1.5;
  }
  std::vector<std::pair<double, int>> order;
  order.reserve(found.size());
  for (const int i : found) order.emplace_back((points_.row(i).transpose() - p).squaredNorm(), i);
  std::partial_sort(order.begin(), order.begin() + wanted, order.end());
  found.clear();
  for (int k = 0; k < wanted; ++k) found.push_back(order[k].second);
}

}  // namespace pregrasp
