#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "app/core/interrupt.h"
#include "app/geometry/iso_surface.h"

namespace pregrasp {

/// One small number for each node of a grid.
using GridMarks = std::vector<std::uint8_t>;

/// The node nearest to p, kept within the grid.
std::array<int, 3> NodeNear(const ScalarGrid& grid, const Vector3& p);

/// How far the next node along each axis is in the grid's numbers.
std::array<std::size_t, 3> StepsOf(const ScalarGrid& grid);

/// Calls visit(x, y, z) for the nodes within `radius` of p.
template <typename Visit>
void VisitBall(const ScalarGrid& grid, const Vector3& p, double radius, Visit&& visit) {
  const std::array<int, 3> low = NodeNear(grid, p - Vector3::Constant(radius));
  const std::array<int, 3> high = NodeNear(grid, p + Vector3::Constant(radius));
  for (int z = low[2]; z <= high[2]; ++z) {
    for (int y = low[1]; y <= high[1]; ++y) {
      for (int x = low[0]; x <= high[0]; ++x) {
        if ((grid.Node(x, y, z) - p).squaredNorm() <= radius * radius) visit(x, y, z);
      }
    }
  }
}

/// Calls visit(x, y, z) for the nodes that have a node on every side.
template <typename Visit>
void VisitInner(const ScalarGrid& grid, Visit&& visit) {
  for (int z = 1; z + 1 < grid.count[2]; ++z) {
    ThrowIfInterrupted();
    for (int y = 1; y + 1 < grid.count[1]; ++y) {
      for (int x = 1; x + 1 < grid.count[0]; ++x) visit(x, y, z);
    }
  }
}

/// Whether an inner node marked `value` has a neighbour that is not.
bool IsFront(const ScalarGrid& grid, const GridMarks& marks, std::size_t at, std::uint8_t value);

/// Marks as 2 all nodes marked 0 that can be reached from the first node through such nodes.
void FloodFromCorner(const ScalarGrid& grid, GridMarks& marks);

/// Marks as `value` all nodes within `distance` [m] of those that are marked so.
void SpreadMark(const ScalarGrid& grid, std::uint8_t value, double distance, GridMarks& marks);

}  // namespace pregrasp
