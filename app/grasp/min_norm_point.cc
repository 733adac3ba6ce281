#include "app/grasp/min_norm_point.h"

namespace pregrasp::internal {

// Householder QR of D = [p1 - p0, p2 - p0, ..]: min |p0 + D a|. Normal equations would be shorter,
// but squaring the condition number costs the last digits that decide borderline sets.
bool CalcAffineMinNorm(const std::array<Vector6, 8>& points, int size,
                       std::array<double, 8>& weights) {
  const int columns = size - 1;
  if (columns > 6) return false;
  std::array<Vector6, 6> d;
  double scale = 0.0;
  for (int j = 0; j < columns; ++j) {
    d[j] = points[j + 1] - points[0];
    scale = std::max(scale, d[j].squaredNorm());
  }
  const double tiny = 1e-26 * scale;
  Vector6 rhs = -points[0];
  for (int j = 0; j < columns; ++j) {
    double tail = 0.0;
    for (int i = j; i < 6; ++i) tail += d[j][i] * d[j][i];
    if (!(tail > tiny)) return false;
    const double alpha = d[j][j] > 0.0 ? -std::sqrt(tail) : std::sqrt(tail);
    d[j][j] -= alpha;  // d[j][j..] is now the reflector
    const double beta = 1.0 / (alpha * d[j][j]);
    for (int k = j + 1; k < columns; ++k) {
      double dot = 0.0;
      for (int i = j; i < 6; ++i) dot += d[j][i] * d[k][i];
      dot *= beta;
      for (int i = j; i < 6; ++i) d[k][i] += dot * d[j][i];
    }
    double dot = 0.0;
    for (int i = j; i < 6; ++i) dot += d[j][i] * rhs[i];
    dot *= beta;
    for (int i = j; i < 6; ++i) rhs[i] += dot * d[j][i];
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
