#include "app/geometry/distance_bounds.h"

#include <algorithm>
#include <cmath>

namespace pregrasp {

DistanceBounds::DistanceBounds(const MeshDistance& distance) : distance_(distance) {
  const AlignedBox& bounds = distance.bounds();
  cell_ = bounds.sizes().maxCoeff() / kResolution;
  for (int k = 0; k < 3; ++k) {
    count_[k] = 1 + static_cast<int>(std::ceil(bounds.sizes()[k] / cell_));
  }
  values_.resize(static_cast<std::size_t>(count_[0]) * count_[1] * count_[2]);
  std::size_t i = 0;
  for (int z = 0; z < count_[2]; ++z) {
    for (int y = 0; y < count_[1]; ++y) {
      for (int x = 0; x < count_[0]; ++x) values_[i++] = distance.Calc(Node(x, y, z));
    }
  }
}

double DistanceBounds::CalcRoughly(const Vector3& p) const {
  const auto [value, slack] = Nearest(p);
  return std::abs(value) > 10.0 * slack ? value : distance_.Calc(p);
}

double DistanceBounds::CalcAbove(const Vector3& p, double floor) const {
  const auto [value, slack] = Nearest(p);
  return value + slack <= floor ? floor : std::max(floor, distance_.Calc(p));
}

std::pair<double, double> DistanceBounds::Nearest(const Vector3& p) const {
  std::array<int, 3> at{};
  const Vector3 q = (p - distance_.bounds().min()) / cell_;
  for (int k = 0; k < 3; ++k) {
    at[k] = static_cast<int>(std::clamp(std::lround(q[k]), 0L, static_cast<long>(count_[k] - 1)));
  }
  const std::size_t i = (static_cast<std::size_t>(at[2]) * count_[1] + at[1]) * count_[0] + at[0];
  return {values_[i], (p - Node(at[0], at[1], at[2])).norm()};
}

}  // namespace pregrasp
