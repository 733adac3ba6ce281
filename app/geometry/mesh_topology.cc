#include "app/geometry/mesh_topology.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "app/core/check.h"

namespace pregrasp {
namespace {

// One side of an edge: face `face` runs along it as its edge `slot`, from the smaller vertex to the
// larger when `forward`.
struct EdgeSide {
  int low, high, face, slot;
  bool forward;
};

// Sorted by edge, then face.
std::vector<EdgeSide> ListEdgeSides(const TriangleMesh& mesh) {
  std::vector<EdgeSide> sides;
  sides.reserve(3 * mesh.F.rows());
  for (int f = 0; f < mesh.F.rows(); ++f) {
    for (int i = 0; i < 3; ++i) {
      const int a = mesh.F(f, i), b = mesh.F(f, (i + 1) % 3);
      sides.push_back({std::min(a, b), std::max(a, b), f, i, a < b});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const EdgeSide& s, const EdgeSide& t) {
    return std::tie(s.low, s.high, s.face, s.slot) < std::tie(t.low, t.high, t.face, t.slot);
  });
  return sides;
}

// Calls visit(first, last) for the sides of each edge.
template <typename Visit>
void ForEachEdge(const std::vector<EdgeSide>& sides, Visit&& visit) {
  for (std::size_t begin = 0; begin < sides.size();) {
    std::size_t end = begin + 1;
    while (end < sides.size() && sides[end].low == sides[begin].low &&
           sides[end].high == sides[begin].high) {
      ++end;
    }
    visit(begin, end);
    begin = end;
  }
}

// Index of the representative of each vertex.
std::vector<int> FindRepresentatives(const MatrixX3& V, double tolerance) {
  std::vector<int> order(V.rows());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int i, int j) {
    return std::make_tuple(V(i, 0), V(i, 1), V(i, 2), i) <
           std::make_tuple(V(j, 0), V(j, 1), V(j, 2), j);
  });
  std::vector<int> representative(V.rows());
  std::iota(representative.begin(), representative.end(), 0);
  const auto find = [&](int i) {
    while (representative[i] != i) i = representative[i] = representative[representative[i]];
    return i;
  };
  for (std::size_t k = 0; k < order.size(); ++k) {
    const int i = order[k];
    for (std::size_t l = k + 1; l < order.size(); ++l) {
      const int j = order[l];
      if (V(j, 0) - V(i, 0) > tolerance) break;
      if ((V.row(j) - V.row(i)).squaredNorm() <= tolerance * tolerance) {
        const int a = find(i), b = find(j);
        representative[std::max(a, b)] = std::min(a, b);
      } else if (tolerance == 0.0) {
        break;  // equal points are neighbours in the order
      }
    }
  }
  for (int i = 0; i < V.rows(); ++i) representative[i] = find(i);
  return representative;
}

// The corners of each face, ascending.
std::vector<std::array<int, 3>> SortCorners(const TriangleMesh& mesh) {
  std::vector<std::array<int, 3>> faces(static_cast<std::size_t>(mesh.F.rows()));
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto row = static_cast<Eigen::Index>(f);
    faces[f] = {mesh.F(row, 0), mesh.F(row, 1), mesh.F(row, 2)};
    std::sort(faces[f].begin(), faces[f].end());
  }
  return faces;
}

// Faces with the corners of an earlier one, in any order.
int CountRepeatedFaces(const TriangleMesh& mesh) {
  std::vector<std::array<int, 3>> faces = SortCorners(mesh);
  std::sort(faces.begin(), faces.end());
  return static_cast<int>(faces.end() - std::unique(faces.begin(), faces.end()));
}

}  // namespace

std::vector<std::array<int, 3>> FindNeighbours(const TriangleMesh& mesh) {
  std::vector<std::array<int, 3>> neighbours(mesh.F.rows(), {-1, -1, -1});
  const std::vector<EdgeSide> sides = ListEdgeSides(mesh);
  ForEachEdge(sides, [&](std::size_t begin, std::size_t end) {
    if (end - begin != 2) return;
    const EdgeSide &s = sides[begin], &t = sides[begin + 1];
    neighbours[s.face][s.slot] = t.face;
    neighbours[t.face][t.slot] = s.face;
  });
  return neighbours;
}

std::vector<Vector3> CalcFaceNormals(const TriangleMesh& mesh,
                                     const std::vector<std::array<int, 3>>& neighbours) {
  std::vector<Vector3> nhats(mesh.F.rows());
  const auto edge = [&](int f, int i) {
    return Vector3(mesh.V.row(mesh.F(f, (i + 1) % 3)) - mesh.V.row(mesh.F(f, i)));
  };
  for (int f = 0; f < mesh.F.rows(); ++f) {
    const Vector3 cross = edge(f, 0).cross(edge(f, 1));
    const double longest =
        std::max({edge(f, 0).squaredNorm(), edge(f, 1).squaredNorm(), edge(f, 2).squaredNorm()});
    const bool flat = cross.norm() <= 1e-10 * longest;  // as in MeshDistance
    nhats[f] = flat ? Vector3::Zero() : cross.normalized();
  }
  constexpr int kRounds = 8;  // slivers may lie side by side
  for (int round = 0; round < kRounds; ++round) {
    bool any = false;
    for (int f = 0; f < mesh.F.rows(); ++f) {
      if (!nhats[f].isZero(0.0)) continue;
      any = true;
      double longest = -1.0;
      for (int i = 0; i < 3; ++i) {
        const int across = neighbours[f][i];
        if (edge(f, i).norm() <= longest || across < 0 || nhats[across].isZero(0.0)) continue;
        longest = edge(f, i).norm();
        nhats[f] = nhats[across];
      }
    }
    if (!any) break;
  }
  return nhats;
}

MeshDefects FindDefects(const TriangleMesh& mesh) {
  MeshDefects defects;
  defects.repeated_faces = CountRepeatedFaces(mesh);
  const std::vector<EdgeSide> sides = ListEdgeSides(mesh);
  ForEachEdge(sides, [&](std::size_t begin, std::size_t end) {
    if (end - begin == 1) ++defects.open_edges;
    if (end - begin > 2) ++defects.crowded_edges;
    if (end - begin == 2 && sides[begin].forward == sides[begin + 1].forward) {
      ++defects.turned_edges;
    }
  });
  return defects;
}

std::vector<std::pair<int, int>> FindOpenEdges(const TriangleMesh& mesh) {
  std::vector<std::pair<int, int>> edges;
  const std::vector<EdgeSide> sides = ListEdgeSides(mesh);
  ForEachEdge(sides, [&](std::size_t begin, std::size_t end) {
    if (end - begin == 1) edges.emplace_back(sides[begin].low, sides[begin].high);
  });
  return edges;
}

std::vector<Hole> FindHoles(const TriangleMesh& mesh) {
  const std::vector<std::pair<int, int>> edges = FindOpenEdges(mesh);
  // The root of a vertex stands for its hole.
  std::vector<int> parent(mesh.V.rows());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root_of = [&](int v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const auto& [a, b] : edges) parent[root_of(a)] = root_of(b);
  std::map<int, Hole> holes;
  for (const auto& [a, b] : edges) {
    Hole& hole = holes[root_of(a)];
    ++hole.edges;
    for (const int v : {a, b}) hole.bounds.extend(Vector3(mesh.V.row(v)));
  }
  std::vector<Hole> list;
  list.reserve(holes.size());
  for (const auto& [root, hole] : holes) list.push_back(hole);
  std::stable_sort(list.begin(), list.end(),
                   [](const Hole& a, const Hole& b) { return a.edges > b.edges; });
  return list;
}

TriangleMesh WeldVertices(const TriangleMesh& mesh, double tolerance) {
  const std::vector<int> representative = FindRepresentatives(mesh.V, tolerance);
  TriangleMesh welded = mesh;
  std::vector<bool> keep(mesh.F.rows());
  for (int f = 0; f < mesh.F.rows(); ++f) {
    for (int i = 0; i < 3; ++i) welded.F(f, i) = representative[mesh.F(f, i)];
    keep[f] = welded.F(f, 0) != welded.F(f, 1) && welded.F(f, 1) != welded.F(f, 2) &&
              welded.F(f, 2) != welded.F(f, 0);
  }
  return TakeFaces(welded, keep);
}

TriangleMesh TakeFaces(const TriangleMesh& mesh, const std::vector<bool>& keep) {
  TriangleMesh taken;
  taken.F.resize(std::count(keep.begin(), keep.end(), true), 3);
  std::vector<int> new_index(mesh.V.rows(), -1);
  int row = 0;
  for (int f = 0; f < mesh.F.rows(); ++f) {
    if (!keep[f]) continue;
    taken.F.row(row++) = mesh.F.row(f);
    for (int i = 0; i < 3; ++i) new_index[mesh.F(f, i)] = 0;
  }
  int count = 0;
  for (int v = 0; v < mesh.V.rows(); ++v) {
    if (new_index[v] == 0) new_index[v] = count++;
  }
  taken.V.resize(count, 3);
  for (int v = 0; v < mesh.V.rows(); ++v) {
    if (new_index[v] >= 0) taken.V.row(new_index[v]) = mesh.V.row(v);
  }
  for (int f = 0; f < taken.F.rows(); ++f) {
    for (int i = 0; i < 3; ++i) taken.F(f, i) = new_index[taken.F(f, i)];
  }
  return taken;
}

std::vector<TriangleMesh> SplitFaces(const TriangleMesh& mesh, const std::vector<int>& part_of,
                                     int count) {
  std::vector<std::vector<int>> faces_of(count);
  for (int f = 0; f < mesh.F.rows(); ++f) faces_of.at(part_of[f]).push_back(f);
  std::vector<int> new_index(mesh.V.rows(), -1);
  std::vector<TriangleMesh> parts;
  for (const std::vector<int>& faces : faces_of) {
    std::vector<int> used;
    for (const int f : faces) {
      for (int i = 0; i < 3; ++i) used.push_back(mesh.F(f, i));
    }
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    TriangleMesh part;
    part.V.resize(static_cast<Eigen::Index>(used.size()), 3);
    for (std::size_t v = 0; v < used.size(); ++v) {
      part.V.row(static_cast<Eigen::Index>(v)) = mesh.V.row(used[v]);
      new_index[used[v]] = static_cast<int>(v);
    }
    part.F.resize(static_cast<Eigen::Index>(faces.size()), 3);
    for (std::size_t f = 0; f < faces.size(); ++f) {
      for (int i = 0; i < 3; ++i) {
        part.F(static_cast<Eigen::Index>(f), i) = new_index[mesh.F(faces[f], i)];
      }
    }
    parts.push_back(std::move(part));
  }
  return parts;
}

TriangleMesh TakeSingleFaces(const TriangleMesh& mesh) {
  const std::vector<std::array<int, 3>> faces = SortCorners(mesh);
  std::vector<std::array<int, 3>> sorted = faces;
  std::sort(sorted.begin(), sorted.end());
  std::vector<bool> keep(faces.size());
  std::transform(faces.begin(), faces.end(), keep.begin(), [&](const std::array<int, 3>& face) {
    const auto [first, last] = std::equal_range(sorted.begin(), sorted.end(), face);
    return last - first == 1;
  });
  return TakeFaces(mesh, keep);
}

std::vector<int> LabelComponents(const TriangleMesh& mesh) {
  const auto neighbours = FindNeighbours(mesh);
  std::vector<int> label(mesh.F.rows(), -1);
  int count = 0;
  std::vector<int> open;
  for (int seed = 0; seed < mesh.F.rows(); ++seed) {
    if (label[seed] >= 0) continue;
    label[seed] = count;
    open.push_back(seed);
    while (!open.empty()) {
      const int f = open.back();
      open.pop_back();
      for (const int g : neighbours[f]) {
        if (g < 0 || label[g] >= 0) continue;
        label[g] = count;
        open.push_back(g);
      }
    }
    ++count;
  }
  return label;
}

bool OrientConsistently(TriangleMesh& mesh) {
  const auto neighbours = FindNeighbours(mesh);
  // Whether faces f and neighbours[f][i] run along their edge the same way as they are now.
  const auto same_way = [&](int f, int i) {
    const int g = neighbours[f][i];
    const int a = mesh.F(f, i), b = mesh.F(f, (i + 1) % 3);
    for (int j = 0; j < 3; ++j) {
      if (mesh.F(g, j) == a && mesh.F(g, (j + 1) % 3) == b) return true;
    }
    return false;
  };
  std::vector<int> turn(mesh.F.rows(), -1);  // 1: against its component's first face
  for (int seed = 0; seed < mesh.F.rows(); ++seed) {
    if (turn[seed] >= 0) continue;
    std::vector<int> members{seed};
    turn[seed] = 0;
    for (std::size_t k = 0; k < members.size(); ++k) {
      const int f = members[k];
      for (int i = 0; i < 3; ++i) {
        const int g = neighbours[f][i];
        if (g < 0) continue;
        const int wanted = same_way(f, i) ? 1 - turn[f] : turn[f];
        if (turn[g] < 0) {
          turn[g] = wanted;
          members.push_back(g);
        } else if (turn[g] != wanted) {
          return false;
        }
      }
    }
    const auto turned =
        std::count_if(members.begin(), members.end(), [&](int f) { return turn[f] == 1; });
    if (2 * turned > static_cast<std::ptrdiff_t>(members.size())) {
      for (const int f : members) turn[f] = 1 - turn[f];
    }
  }
  for (int f = 0; f < mesh.F.rows(); ++f) {
    if (turn[f] == 1) std::swap(mesh.F(f, 1), mesh.F(f, 2));
  }
  return true;
}

void SplitPinchedVertices(TriangleMesh& mesh) {
  const auto neighbours = FindNeighbours(mesh);
  std::vector<bool> visited(3 * mesh.F.rows(), false);  // corners
  std::vector<bool> taken(mesh.V.rows(), false);
  std::vector<int> copies;  // of which vertex
  for (int corner = 0; corner < 3 * mesh.F.rows(); ++corner) {
    if (visited[corner]) continue;
    const int vertex = mesh.F(corner / 3, corner % 3);
    const bool split = taken[vertex];
    const int index =
        split ? static_cast<int>(mesh.V.rows()) + static_cast<int>(copies.size()) : vertex;
    if (split) copies.push_back(vertex);
    taken[vertex] = true;
    std::vector<int> fan{corner};
    visited[corner] = true;
    for (std::size_t k = 0; k < fan.size(); ++k) {
      const int f = fan[k] / 3, i = fan[k] % 3;
      for (const int slot : {i, (i + 2) % 3}) {  // the two edges at this corner
        const int g = neighbours[f][slot];
        if (g < 0) continue;
        for (int j = 0; j < 3; ++j) {
          if (mesh.F(g, j) == vertex && !visited[3 * g + j]) {
            visited[3 * g + j] = true;
            fan.push_back(3 * g + j);
          }
        }
      }
    }
    for (const int c : fan) mesh.F(c / 3, c % 3) = index;
  }
  const int old_count = static_cast<int>(mesh.V.rows());
  mesh.V.conservativeResize(old_count + static_cast<int>(copies.size()), 3);
  for (std::size_t k = 0; k < copies.size(); ++k) {
    mesh.V.row(old_count + static_cast<int>(k)) = mesh.V.row(copies[k]);
  }
}

double CalcVolume(const TriangleMesh& mesh) {
  if (mesh.V.rows() == 0) return 0.0;
  const Vector3 origin = mesh.V.row(0);  // near the mesh, so that far placement costs no digits
  double sum = 0.0;
  for (int f = 0; f < mesh.F.rows(); ++f) {
    const Vector3 a = mesh.V.row(mesh.F(f, 0)).transpose() - origin;
    const Vector3 b = mesh.V.row(mesh.F(f, 1)).transpose() - origin;
    const Vector3 c = mesh.V.row(mesh.F(f, 2)).transpose() - origin;
    sum += a.dot(b.cross(c));
  }
  return sum / 6.0;
}

double CalcArea(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (int f = 0; f < mesh.F.rows(); ++f) {
    const Vector3 a = mesh.V.row(mesh.F(f, 0));
    const Vector3 b = mesh.V.row(mesh.F(f, 1)), c = mesh.V.row(mesh.F(f, 2));
    sum += 0.5 * (b - a).cross(c - a).norm();
  }
  return sum;
}

int CalcEulerNumber(const TriangleMesh& mesh) {
  PREGRASP_CHECK(mesh.F.rows() % 2 == 0, mesh.F.rows());
  return static_cast<int>(mesh.V.rows() - mesh.F.rows() / 2);  // 3 F / 2 edges
}

double CalcWindingNumber(const TriangleMesh& mesh, const Vector3& p) {
  double sum = 0.0;
  for (int f = 0; f < mesh.F.rows(); ++f) {
    const Vector3 a = mesh.V.row(mesh.F(f, 0)).transpose() - p;
    const Vector3 b = mesh.V.row(mesh.F(f, 1)).transpose() - p;
    const Vector3 c = mesh.V.row(mesh.F(f, 2)).transpose() - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    // Solid angle (Van Oosterom and Strackee 1983).
    sum += 2.0 * std::atan2(a.dot(b.cross(c)),
                            la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (4.0 * kPi);
}

TriangleMesh Transformed(const TriangleMesh& mesh, const RigidTransform& X_AB) {
  TriangleMesh moved = mesh;
  for (int v = 0; v < mesh.V.rows(); ++v) {
    moved.V.row(v) = (X_AB * Vector3(mesh.V.row(v))).transpose();
  }
  return moved;
}

void AppendMesh(TriangleMesh& mesh, const TriangleMesh& other) {
  const int vertices = static_cast<int>(mesh.V.rows()), faces = static_cast<int>(mesh.F.rows());
  mesh.V.conservativeResize(vertices + other.V.rows(), 3);
  mesh.V.bottomRows(other.V.rows()) = other.V;
  mesh.F.conservativeResize(faces + other.F.rows(), 3);
  mesh.F.bottomRows(other.F.rows()) = other.F.array() + vertices;
}

}  // namespace pregrasp
