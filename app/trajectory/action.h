#pragma once

#include <vector>

#include "app/geometry/signed_distance.h"
#include "app/graph/contact_path.h"
#include "app/trajectory/plan.h"

namespace pregrasp {

/// Ranges of what an action can ask for. They follow from the scene and are the same rule for all.
struct ActionRange {
  double max_depth = 0.0;    ///< largest spring deflection [m]
  double cone = 0.0;         ///< tangent over depth; below the friction coefficient, as a margin
  double max_travel = 0.03;  ///< of the target in one knot, each axis [m]
};

/// The rule: deflections of up to three times the object's weight (at least 0.6 N, at most the
/// cap), tangents inside nine tenths of the cone.
ActionRange MakeActionRange(const Scene& scene, double max_travel);

/// A flat vector of unbounded numbers, Gaussian-sampled by MPPI, and what it means on a given path:
/// for each stage and finger one number whose sign is the contact bit, two that are squashed to a
/// point of the stage's triangle, and six a knot.
class ActionSpace {
 public:
  ActionSpace(const ContactGraph& graph, const std::vector<int>& path_nodes,
              const SignedDistance& shape, const ActionRange& range, int knots);

  int size() const { return num_stages_ * kNumPlanningFingers * FingerSize(); }

  /// Bit: on if positive. Position: (1 + tanh) / 2. Depth: (1 + tanh) / 2 of the range. Tangent:
  /// the vector scaled by tanh of its length, so that directions are uniform. Travel: tanh. A
  /// finger that was on in the stage before keeps its contact (paper: it may change its location
  /// only after a stage without contact).
  RelativePlan Decode(const std::vector<double>& action) const;

 private:
  static constexpr int kKnotSize = 6;
  int FingerSize() const { return 3 + kKnotSize * knots_; }

  const TriangleMesh* mesh_;
  const SignedDistance* shape_;
  std::vector<std::array<int, kNumPlanningFingers>> triangles_;  // by stage
  ActionRange range_;
  int num_stages_, knots_;
};

}  // namespace pregrasp
