#include "app/geometry/split_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

namespace pregrasp {
namespace {

// A triangle at an edge: it runs along it as its edge `slot`, from the smaller vertex to the larger
// when `forward`.
struct Side {
  int face, slot;
  bool forward;
  double angle = 0.0;  // about the edge [rad]
};

using Edge = std::pair<int, int>;  // the smaller vertex first

std::map<Edge, std::vector<Side>> ListSides(const TriangleMesh& mesh) {
  std::map<Edge, std::vector<Side>> sides;
  for (int f = 0; f < mesh.F.rows(); ++f) {
    for (int i = 0; i < 3; ++i) {
      const int a = mesh.F(f, i), b = mesh.F(f, (i + 1) % 3);
      sides[std::minmax(a, b)].push_back({f, i, a < b});
    }
  }
  return sides;
}

// The sides in pairs with the solid between the two, or none. Seen along the edge with angles
// counter-clockwise, the solid begins at a side that runs backward and ends at one that runs
// forward.
std::vector<std::pair<Side, Side>> PairUp(const TriangleMesh& mesh, const Edge& edge,
                                          std::vector<Side> sides) {
  if (sides.size() % 2 != 0) return {};
  const Vector3 from = mesh.V.row(edge.first);
  const Vector3 axis = (Vector3(mesh.V.row(edge.second)) - from).normalized();
  Vector3 x = Vector3::Zero();
  for (Side& side : sides) {
    const Vector3 third = mesh.V.row(mesh.F(side.face, (side.slot + 2) % 3));
    const Vector3 arm = (third - from) - (third - from).dot(axis) * axis;
    if (x.isZero(0.0)) x = arm.normalized();
    side.angle = std::atan2(arm.dot(axis.cross(x)), arm.dot(x));
  }
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b) { return a.angle < b.angle; });
  constexpr double kSame = 1e-6;  // [rad]
  std::vector<std::pair<Side, Side>> pairs;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Side &side = sides[i], &next = sides[(i + 1) % sides.size()];
    const double turn = next.angle - side.angle + (i + 1 == sides.size() ? 2.0 * kPi : 0.0);
    if (side.forward == next.forward || !(turn > kSame)) return {};
    if (!side.forward) pairs.emplace_back(side, next);
  }
  return pairs;
}

}  // namespace

bool SplitCrowdedEdges(TriangleMesh& mesh) {
  // The corners of one vertex that stay together.
  std::vector<int> parent(3 * mesh.F.rows());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root_of = [&](int corner) {
    while (parent[corner] != corner) corner = parent[corner] = parent[parent[corner]];
    return corner;
  };
  const auto join = [&](const Side& a, const Side& b) {
    const auto corners = [](const Side& side) {
      std::array<int, 2> ends = {3 * side.face + side.slot, 3 * side.face + (side.slot + 1) % 3};
      if (!side.forward) std::swap(ends[0], ends[1]);
      return ends;
    };
    for (int end = 0; end < 2; ++end) {
      const int s = root_of(corners(a)[end]), t = root_of(corners(b)[end]);
      parent[std::max(s, t)] = std::min(s, t);
    }
  };
  for (const auto& [edge, sides] : ListSides(mesh)) {
    if (sides.size() == 2) join(sides[0], sides[1]);
    if (sides.size() <= 2) continue;
    const auto pairs = PairUp(mesh, edge, sides);
    if (pairs.empty()) return false;
    for (const auto& [a, b] : pairs) join(a, b);
  }
  const MatrixX3 V = mesh.V;
  std::vector<int> vertex_of(parent.size(), -1);  // of each group of corners, by its root
  std::vector<bool> taken(V.rows(), false);
  std::vector<int> copied;
  for (int corner = 0; corner < static_cast<int>(parent.size()); ++corner) {
    int& vertex = vertex_of[root_of(corner)];
    int& old = mesh.F(corner / 3, corner % 3);
    if (vertex < 0) {
      vertex = taken[old] ? static_cast<int>(V.rows() + copied.size()) : old;
      if (taken[old]) copied.push_back(old);
      taken[old] = true;
    }
    old = vertex;
  }
  mesh.V.conservativeResize(V.rows() + static_cast<Eigen::Index>(copied.size()), 3);
  for (std::size_t i = 0; i < copied.size(); ++i) {
    mesh.V.row(V.rows() + static_cast<Eigen::Index>(i)) = V.row(copied[i]);
  }
  return true;
}

}  // namespace pregrasp
