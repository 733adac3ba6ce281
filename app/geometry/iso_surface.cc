#include "app/geometry/iso_surface.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "app/core/interrupt.h"

namespace pregrasp {
namespace {

// The six tetrahedra of a cube around the diagonal from corner 0 to 7; bit i of a corner's number
// is its side along axis i. Each follows one order of the axes, so that faces of neighbouring
// cubes are cut the same way.
constexpr std::array<std::array<int, 4>, 6> kTetrahedra{
    {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}}};

class Extractor {
 public:
  explicit Extractor(const ScalarGrid& grid) : grid_(grid) {}

  TriangleMesh Run() {
    for (int z = 0; z + 1 < grid_.count[2]; ++z) {
      ThrowIfInterrupted();
      for (int y = 0; y + 1 < grid_.count[1]; ++y) {
        for (int x = 0; x + 1 < grid_.count[0]; ++x) AddCube(x, y, z);
      }
    }
    return Finish();
  }

 private:
  using EdgeKey = std::pair<std::uint64_t, std::uint64_t>;  // nodes, the smaller first

  void AddCube(int x, int y, int z) {
    std::array<std::uint64_t, 8> node{};
    int inside = 0;
    for (int c = 0; c < 8; ++c) {
      node[c] = grid_.Index(x + (c & 1), y + ((c >> 1) & 1), z + ((c >> 2) & 1));
      if (grid_.values[node[c]] < 0.0F) ++inside;
    }
    if (inside == 0 || inside == 8) return;
    for (const auto& corners : kTetrahedra) {
      AddTetrahedron({node[corners[0]], node[corners[1]], node[corners[2]], node[corners[3]]});
    }
  }

  // The corners are ordered so that (1 - 0) x (2 - 0) . (3 - 0) is positive.
  void AddTetrahedron(std::array<std::uint64_t, 4> node) {
    std::array<int, 4> in{}, out{};
    int num_in = 0, num_out = 0;
    for (int i = 0; i < 4; ++i) {
      if (grid_.values[node[i]] < 0.0F) {
        in[num_in++] = i;
      } else {
        out[num_out++] = i;
      }
    }
    if (num_in == 0 || num_out == 0) return;
    // An even permutation of the corners (in.., out..) keeps the orientation.
    std::array<int, 4> order{};
    for (int i = 0; i < num_in; ++i) order[i] = in[i];
    for (int i = 0; i < num_out; ++i) order[num_in + i] = out[i];
    int inversions = 0;
    for (int i = 0; i < 4; ++i) {
      for (int j = i + 1; j < 4; ++j) inversions += order[i] > order[j] ? 1 : 0;
    }
    if (inversions % 2 == 1) std::swap(order[2], order[3]);
    const auto edge = [&](int i, int j) {
      return EdgeKey(std::minmax(node[order[i]], node[order[j]]));
    };
    if (num_in == 1) {
      AddTriangle(edge(0, 1), edge(0, 2), edge(0, 3));
    } else if (num_in == 3) {
      // The last corner is outside, unless the swap moved it.
      const int apex = grid_.values[node[order[3]]] < 0.0F ? 2 : 3;
      if (apex == 3) {
        AddTriangle(edge(0, 3), edge(1, 3), edge(2, 3));
      } else {
        AddTriangle(edge(0, 2), edge(3, 2), edge(1, 2));
      }
    } else {
      AddTriangle(edge(0, 2), edge(0, 3), edge(1, 3));
      AddTriangle(edge(0, 2), edge(1, 3), edge(1, 2));
    }
  }

  void AddTriangle(const EdgeKey& a, const EdgeKey& b, const EdgeKey& c) {
    corners_.push_back(a);
    corners_.push_back(b);
    corners_.push_back(c);
  }

  Vector3 NodeAt(std::uint64_t index) const {
    const auto nx = static_cast<std::uint64_t>(grid_.count[0]);
    const auto ny = static_cast<std::uint64_t>(grid_.count[1]);
    return grid_.Node(static_cast<int>(index % nx), static_cast<int>(index / nx % ny),
                      static_cast<int>(index / (nx * ny)));
  }

  // One vertex for each edge that was met, numbered in the order of the edges.
  TriangleMesh Finish() const {
    std::vector<EdgeKey> edges = corners_;
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    TriangleMesh mesh;
    mesh.V.resize(static_cast<int>(edges.size()), 3);
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const double a = grid_.values[edges[e].first], b = grid_.values[edges[e].second];
      // Kept off the nodes, where several edges' vertices would fall together.
      const double s = std::clamp(a / (a - b), 0.02, 0.98);
      const Vector3 p = (1.0 - s) * NodeAt(edges[e].first) + s * NodeAt(edges[e].second);
      mesh.V.row(static_cast<int>(e)) = p.transpose();
    }
    const auto faces = static_cast<int>(corners_.size() / 3);
    mesh.F.resize(faces, 3);
    for (int f = 0; f < faces; ++f) {
      for (int i = 0; i < 3; ++i) {
        const auto it = std::lower_bound(edges.begin(), edges.end(), corners_[3 * f + i]);
        mesh.F(f, i) = static_cast<int>(it - edges.begin());
      }
    }
    return mesh;
  }

  const ScalarGrid& grid_;
  std::vector<EdgeKey> corners_;
};

}  // namespace

ScalarGrid MakeGrid(const AlignedBox& bounds, int nodes, int padding) {
  ScalarGrid grid;
  const Vector3 size = bounds.sizes();
  // By bisection, since the padding counts too.
  double low = size.maxCoeff() / nodes, high = size.maxCoeff();
  const auto count_at = [&](double cell) {
    double product = 1.0;
    for (int k = 0; k < 3; ++k) product *= std::ceil(size[k] / cell) + 1.0 + 2.0 * padding;
    return product;
  };
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (count_at(middle) > nodes ? low : high) = middle;
  }
  grid.cell = high;
  for (int k = 0; k < 3; ++k) {
    const int cells = static_cast<int>(std::ceil(size[k] / grid.cell)) + 2 * padding;
    grid.count[k] = cells + 1;
    grid.p_min[k] = bounds.center()[k] - 0.5 * cells * grid.cell;
  }
  grid.values.assign(static_cast<std::size_t>(grid.count[0]) * grid.count[1] * grid.count[2], 0.0F);
  return grid;
}

TriangleMesh ExtractSurface(const ScalarGrid& grid) { return Extractor(grid).Run(); }

}  // namespace pregrasp
