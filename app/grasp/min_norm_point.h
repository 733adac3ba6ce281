#pragma once

#include <array>
#include <cmath>

#include "app/core/math.h"

namespace pregrasp {

using Vector6 = Eigen::Matrix<double, 6, 1>;

struct MinNormConfig {
  /// A norm at most this counts as zero: the set contains the origin. In the set's own unit.
  double tolerance = 1e-10;
  /// Stop as soon as a hyperplane is known that keeps the whole set at least this far from the
  /// origin. Infinity: go on to the nearest point itself.
  double separation = 1e-12;
  int max_iterations = 400;
};

struct MinNormPoint {
  enum class Status {
    kContainsOrigin,  ///< |v| <= tolerance
    kSeparated,       ///< v x >= lower_bound |v| > 0 for all x in the set
    kStalled,         ///< neither could be shown within the iterations or the arithmetic
  };
  Status status = Status::kStalled;
  Vector6 v = Vector6::Zero();  ///< the nearest point found so far
  /// The distance of the origin from the set is at least this; -infinity before the first bound.
  double lower_bound = -std::numeric_limits<double>::infinity();
  int iterations = 0;
  /// v is the sum of weight[i] times the support point last written to slot[i], i < size.
  int size = 0;
  std::array<int, 7> slot{};
  std::array<double, 7> weight{};
};

namespace internal {

/// The weights (summing to 1) of the point of smallest norm in the affine hull of size <= 7 points;
/// false if these are affinely dependent to working precision.
bool CalcAffineMinNorm(const std::array<Vector6, 8>& points, int size,
                       std::array<double, 8>& weights);

}  // namespace internal

/// The point nearest to the origin in a compact convex set of R^6 that is known by its support
/// function (Wolfe, "Finding the nearest point in a polytope", Math. Programming 11, 1976, with the
/// polytope's vertices generated on demand as in Gilbert, Johnson and Keerthi 1988). Finite for
/// polytopes; for curved sets the bounds close in geometrically.
/// @param start    any point of the set; what the caller keeps for it is kept under slot 0.
/// @param support  called as support(direction, slot, point): sets point to a point of the set that
///                 is farthest along direction; what the caller keeps for it belongs to slot 0..7.
template <typename Support>
MinNormPoint FindMinNormPoint(const Vector6& start, Support&& support,
                              const MinNormConfig& config) {
  std::array<Vector6, 8> points;
  std::array<double, 8> weights{}, target{};
  std::array<int, 8> slots{0, 1, 2, 3, 4, 5, 6, 7};  // slots[size..] are free
  points[0] = start;
  weights[0] = 1.0;
  int size = 1;

  MinNormPoint result;
  double best = std::numeric_limits<double>::infinity();
  while (true) {
    Vector6 v = Vector6::Zero();
    for (int i = 0; i < size; ++i) v += weights[i] * points[i];
    const double norm = v.norm();
    const bool progress = norm < best * (1.0 - 1e-14);
    if (progress || result.iterations == 0) {
      best = norm;
      result.v = v;
      result.size = std::min(size, 7);
      for (int i = 0; i < result.size; ++i) {
        result.slot[i] = slots[i];
        result.weight[i] = weights[i];
      }
    }
    if (norm <= config.tolerance) {
      result.status = MinNormPoint::Status::kContainsOrigin;
      return result;
    }
    if (!progress || result.iterations == config.max_iterations) break;
    ++result.iterations;

    // A new vertex beyond the plane through v, or the plane is the answer.
    support(Vector6(-v), slots[size], points[size]);
    const double bound = v.dot(points[size]) / norm;
    if (bound > result.lower_bound) result.lower_bound = bound;
    if (bound >= config.separation || norm - bound <= 1e-12 * norm) {
      result.status = MinNormPoint::Status::kSeparated;
      return result;
    }
    weights[size++] = 0.0;

    // Move to the affine minimum, dropping every vertex whose weight would turn negative.
    while (true) {
      if (!internal::CalcAffineMinNorm(points, size, target)) {
        result.status = result.lower_bound > 0.0 ? MinNormPoint::Status::kSeparated
                                                 : MinNormPoint::Status::kStalled;
        return result;
      }
      double step = 1.0;
      int leaving = -1;
      for (int i = 0; i < size; ++i) {
        if (target[i] > 0.0) continue;
        const double ratio = weights[i] / (weights[i] - target[i]);
        if (leaving < 0 || ratio < step) {
          step = ratio;
          leaving = i;
        }
      }
      if (leaving < 0) {
        weights = target;
        break;
      }
      for (int i = 0; i < size; ++i) weights[i] += step * (target[i] - weights[i]);
      weights[leaving] = 0.0;
      int kept = 0;
      for (int i = 0; i < size; ++i) {
        if (i == leaving) continue;
        std::swap(slots[kept], slots[i]);
        points[kept] = points[i];
        weights[kept++] = weights[i];
      }
      size = kept;
    }
  }
  if (result.lower_bound > 0.0) result.status = MinNormPoint::Status::kSeparated;
  return result;
}

}  // namespace pregrasp
