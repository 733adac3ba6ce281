#pragma once

#include <array>
#include <vector>

#include "app/core/math.h"

namespace pregrasp {

/// Points in the cells of a regular grid, for questions about neighbours.
class PointIndex {
 public:
  /// @param cell  edge length of a cell [m]; about the radius that is asked for.
  PointIndex(const MatrixX3& points, double cell);

  /// Indices of the points within `radius` of p, ascending.
  void FindWithin(const Vector3& p, double radius, std::vector<int>& found) const;

  /// The `count` points nearest to p, nearest first, ties by index; fewer if there are no more.
  void FindNearest(const Vector3& p, int count, std::vector<int>& found) const;

 private:
  std::array<int, 3> CellOf(const Vector3& p) const;

  MatrixX3 points_;
  double cell_;
  Vector3 p_min_ = Vector3::Zero();
  std::array<int, 3> count_{};
  std::vector<int> first_;  // of each cell in order_, and one past the last
  std::vector<int> order_;
};

}  // namespace pregrasp
