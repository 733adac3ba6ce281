#pragma once

#include <array>
#include <vector>

#include "app/geometry/bounds.h"
#include "app/scene/shape.h"

namespace pregrasp {

/// Numbers at the nodes of a regular grid; x runs fastest.
struct ScalarGrid {
  Vector3 p_min = Vector3::Zero();  ///< of node (0, 0, 0) [m]
  double cell = 1.0;                ///< edge length [m]
  std::array<int, 3> count{};       ///< nodes along each axis
  std::vector<float> values;

  std::size_t Index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * count[1] + y) * count[0] + x;
  }
  Vector3 Node(int x, int y, int z) const { return p_min + cell * Vector3(x, y, z); }
};

/// An empty grid over `bounds` with `padding` cells more on each side, of about `nodes` nodes.
ScalarGrid MakeGrid(const AlignedBox& bounds, int nodes, int padding);

/// The surface on which the grid's values pass from negative (inside) to positive, by marching
/// tetrahedra on cubes cut in six along one diagonal (Kuhn): no ambiguous cases, so the mesh is
/// closed and two-manifold as long as all values on the grid's border are positive. Outward.
TriangleMesh ExtractSurface(const ScalarGrid& grid);

}  // namespace pregrasp
