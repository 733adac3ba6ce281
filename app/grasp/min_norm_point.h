#pragma once

#include <algorithm>
#include <array>
#include <limits>

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

/// Up to seven affinely independent points of a convex set, the weights of the point of smallest
/// norm among their combinations, and room for one point more.
class Corral {
 public:
  explicit Corral(const Vector6& start);

  /// The slot and the place of the next point to add; AddPoint takes it in, with weight 0.
  int free_slot() const { return slots_[size_]; }
  Vector6& free_point() { return points_[size_]; }
  void AddPoint() { weights_[size_++] = 0.0; }

  /// Moves the weights to those of smallest norm, leaving out points that these do not need.
  void Reduce();

  Vector6 CalcPoint() const;
  /// Copies slots and weights.
  void Describe(MinNormPoint* point) const;

 private:
  // The change of weights that leads to the affine minimum; or, and then false, one that moves
  // nothing, because the points are affinely dependent to working precision.
  bool CalcDirection(std::array<double, 8>& direction) const;
  bool StepAndDrop(const std::array<double, 8>& direction, double longest);
  void Remove(int index);

  int size_ = 1;
  std::array<Vector6, 8> points_;
  std::array<double, 8> weights_{};
  std::array<int, 8> slots_{0, 1, 2, 3, 4, 5, 6, 7};  // those from size_ on are free
};

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
  // Below these shares of the norm, a step is rounding.
  constexpr double kLeastStep = 1e-14;
  constexpr double kClosedGap = 1e-12;
  using Status = MinNormPoint::Status;

  internal::Corral corral(start);
  MinNormPoint result;
  double norm = std::numeric_limits<double>::infinity();
  while (true) {
    const Vector6 v = corral.CalcPoint();
    const double last_norm = norm;
    norm = v.norm();
    if (!(norm < last_norm * (1.0 - kLeastStep)) && result.iterations > 0) break;
    result.v = v;
    corral.Describe(&result);
    if (norm <= config.tolerance) {
      result.status = Status::kContainsOrigin;
      return result;
    }
    if (result.iterations++ == config.max_iterations) break;

    // Either there is a vertex beyond the plane through v, or that plane is the answer.
    support(Vector6(-v), corral.free_slot(), corral.free_point());
    const double bound = v.dot(corral.free_point()) / norm;
    result.lower_bound = std::max(result.lower_bound, bound);
    if (bound >= config.separation || norm - bound <= kClosedGap * norm) {
      result.status = Status::kSeparated;
      return result;
    }
    corral.AddPoint();
    corral.Reduce();
  }
  result.status = result.lower_bound > 0.0 ? Status::kSeparated : Status::kStalled;
  return result;
}

}  // namespace pregrasp
