#include "app/grasp/min_norm_point.h"

#include <cmath>
#include <utility>

namespace pregrasp::internal {

Corral::Corral(const Vector6& start) {
  points_[0] = start;
  weights_[0] = 1.0;
}

Vector6 Corral::CalcPoint() const {
  Vector6 v = Vector6::Zero();
  for (int i = 0; i < size_; ++i) v += weights_[i] * points_[i];
  return v;
}

void Corral::Describe(MinNormPoint* point) const {
  point->size = size_;
  for (int i = 0; i < size_; ++i) {
    point->slot[i] = slots_[i];
    point->weight[i] = weights_[i];
  }
}

void Corral::Remove(int index) {
  int kept = 0;
  for (int i = 0; i < size_; ++i) {
    if (i == index) continue;
    std::swap(slots_[kept], slots_[i]);
    points_[kept] = points_[i];
    weights_[kept++] = weights_[i];
  }
  size_ = kept;
}

bool Corral::Reduce() {
  std::array<double, 8> target{};
  while (CalcAffineMinimum(target)) {
    // Go there, or only as far as until the first weight is used up.
    double step = 1.0;
    int leaving = -1;
    for (int i = 0; i < size_; ++i) {
      if (target[i] > 0.0) continue;
      const double ratio = weights_[i] / (weights_[i] - target[i]);
      if (leaving < 0 || ratio < step) {
        step = ratio;
        leaving = i;
      }
    }
    if (leaving < 0) {
      weights_ = target;
      return true;
    }
    for (int i = 0; i < size_; ++i) weights_[i] += step * (target[i] - weights_[i]);
    Remove(leaving);
  }
  return false;
}

// The weights, summing to 1, of the point of smallest norm in the affine hull. By Householder QR of
// D = [p1 - p0, p2 - p0, ..]: min |p0 + D a|. Normal equations would be shorter, but squaring the
// condition number costs the last digits that decide borderline sets.
bool Corral::CalcAffineMinimum(std::array<double, 8>& weights) const {
  const int columns = size_ - 1;
  if (columns > 6) return false;
  std::array<Vector6, 6> d;
  double scale = 0.0;
  for (int j = 0; j < columns; ++j) {
    d[j] = points_[j + 1] - points_[0];
    scale = std::max(scale, d[j].squaredNorm());
  }
  const double tiny = 1e-26 * scale;
  Vector6 rhs = -points_[0];
  for (int j = 0; j < columns; ++j) {
    double tail = 0.0;
    for (int i = j; i < 6; ++i) tail += d[j][i] * d[j][i];
    if (!(tail > tiny)) return false;
    const double alpha = d[j][j] > 0.0 ? -std::sqrt(tail) : std::sqrt(tail);
    d[j][j] -= alpha;  // d[j][j..] is now the reflector
    const double beta = 1.0 / (alpha * d[j][j]);
    const auto reflect = [&](Vector6& x) {
      double dot = 0.0;
      for (int i = j; i < 6; ++i) dot += d[j][i] * x[i];
      for (int i = j; i < 6; ++i) x[i] += beta * dot * d[j][i];
    };
    for (int k = j + 1; k < columns; ++k) reflect(d[k]);
    reflect(rhs);
    d[j][j] = alpha;
  }
  double sum = 0.0;
  for (int j = columns - 1; j >= 0; --j) {
    double value = rhs[j];
    for (int k = j + 1; k < columns; ++k) value -= d[k][j] * weights[k + 1];
    weights[j + 1] = value / d[j][j];
    sum += weights[j + 1];
  }
  weights[0] = 1.0 - sum;
  return true;
}

}  // namespace pregrasp::internal
