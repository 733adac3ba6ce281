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

// Takes the largest step along `direction` that leaves no weight negative, at most 1, and drops
// the point that limits it. False if none did.
bool Corral::StepAndDrop(const std::array<double, 8>& direction, double longest) {
  double step = longest;
  int leaving = -1;
  for (int i = 0; i < size_; ++i) {
    if (!(weights_[i] + longest * direction[i] <= 0.0)) continue;
    const double ratio = weights_[i] / -direction[i];
    if (leaving < 0 || ratio < step) {
      step = ratio;
      leaving = i;
    }
  }
  for (int i = 0; i < size_; ++i) weights_[i] += step * direction[i];
  if (leaving < 0) return false;
  Remove(leaving);
  return true;
}

void Corral::Reduce() {
  constexpr double kFar = 1e300;
  std::array<double, 8> direction{};
  while (true) {
    const bool independent = CalcDirection(direction);
    // Dependent points: their weights can be shifted without moving the point they make until one
    // of them is not needed (Caratheodory).
    if (!StepAndDrop(direction, independent ? 1.0 : kFar)) return;
  }
}

// By Householder QR of D = [p1 - p0, p2 - p0, ..]: the affine minimum is that of |p0 + D a|. Normal
// equations would be shorter, but squaring the condition number costs the last digits that decide
// borderline sets.
bool Corral::CalcDirection(std::array<double, 8>& direction) const {
  const int columns = size_ - 1;
  std::array<Vector6, 7> d;
  double scale = 0.0;
  for (int j = 0; j < columns; ++j) {
    d[j] = points_[j + 1] - points_[0];
    scale = std::max(scale, d[j].squaredNorm());
  }
  const double tiny = 1e-26 * scale;
  // Solves R a = rhs for the first `count` columns into direction[1..count].
  const auto solve = [&](int count, const Vector6& rhs) {
    double sum = 0.0;
    for (int j = count - 1; j >= 0; --j) {
      double value = rhs[j];
      for (int k = j + 1; k < count; ++k) value -= d[k][j] * direction[k + 1];
      direction[j + 1] = value / d[j][j];
      sum += direction[j + 1];
    }
    return sum;
  };
  Vector6 rhs = -points_[0];
  for (int j = 0; j < columns; ++j) {
    double tail = 0.0;
    for (int i = j; i < 6; ++i) tail += d[j][i] * d[j][i];
    if (!(tail > tiny)) {  // column j is a combination of those before it
      const double sum = solve(j, d[j]);
      direction[0] = 1.0 - sum;
      direction[j + 1] = -1.0;
      for (int k = j + 2; k < size_; ++k) direction[k] = 0.0;
      return false;
    }
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
  direction[0] = 1.0 - solve(columns, rhs);
  for (int i = 0; i < size_; ++i) direction[i] -= weights_[i];
  return true;
}

}  // namespace pregrasp::internal
