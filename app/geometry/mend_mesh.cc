#include "app/geometry/mend_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "app/geometry/bounds.h"
#include "app/geometry/mesh_topology.h"

namespace pregrasp {
namespace {

constexpr double kSameCorner = 1e-4;  // of the mesh's diagonal

double Diagonal(const TriangleMesh& mesh) {
  return (mesh.V.colwise().maxCoeff() - mesh.V.colwise().minCoeff()).norm();
}

int MergeCorners(TriangleMesh& mesh) {
  const int open = FindDefects(mesh).open_edges;
  if (open == 0) return 0;
  TriangleMesh merged = WeldVertices(mesh, kSameCorner * Diagonal(mesh));
  if (merged.F.rows() == 0 || FindDefects(merged).open_edges >= open) return 0;
  const auto count = static_cast<int>(mesh.V.rows() - merged.V.rows());
  mesh = std::move(merged);
  return count;
}

int DropRepeatedFaces(TriangleMesh& mesh) {
  std::set<std::array<int, 3>> seen;
  std::vector<bool> keep(mesh.F.rows());
  int dropped = 0;
  for (int f = 0; f < mesh.F.rows(); ++f) {
    std::array<int, 3> corners = {mesh.F(f, 0), mesh.F(f, 1), mesh.F(f, 2)};
    std::sort(corners.begin(), corners.end());
    keep[f] = seen.insert(corners).second;
    dropped += !keep[f];
  }
  if (dropped > 0) mesh = TakeFaces(mesh, keep);
  return dropped;
}

// The rims of holes: closed ways along open edges, those without branches. Vertices in the order in
// which a face that fills the hole has them.
std::vector<std::vector<int>> FindRims(const TriangleMesh& mesh) {
  const std::vector<std::array<int, 3>> neighbours = FindNeighbours(mesh);
  std::vector<std::vector<int>> next(mesh.V.rows());
  std::set<std::pair<int, int>> edges;  // as their faces have them
  for (int f = 0; f < mesh.F.rows(); ++f) {
    for (int i = 0; i < 3; ++i) {
      if (neighbours[f][i] >= 0) continue;
      const int a = mesh.F(f, i), b = mesh.F(f, (i + 1) % 3);
      edges.emplace(a, b);
      next[a].push_back(b);
      next[b].push_back(a);
    }
  }
  std::vector<std::vector<int>> rims;
  std::vector<bool> visited(mesh.V.rows());
  for (int start = 0; start < mesh.V.rows(); ++start) {
    if (next[start].empty() || visited[start]) continue;
    std::vector<int> rim;
    bool branches = false;
    int from = -1, at = start;
    while (at >= 0 && !visited[at]) {
      visited[at] = true;
      rim.push_back(at);
      branches = branches || next[at].size() != 2;
      const auto onwards = std::find_if(next[at].begin(), next[at].end(),
                                        [from](int vertex) { return vertex != from; });
      from = at;
      at = onwards == next[at].end() ? -1 : *onwards;
    }
    if (branches || at != start || rim.size() < 3) continue;
    if (edges.count({rim[0], rim[1]}) > 0) std::reverse(rim.begin(), rim.end());
    rims.push_back(std::move(rim));
  }
  return rims;
}

void Close(TriangleMesh& mesh, const std::vector<int>& rim) {
  const auto count = static_cast<int>(rim.size());
  const auto first = mesh.F.rows();
  if (count == 3) {
    mesh.F.conservativeResize(first + 1, 3);
    mesh.F.row(first) << rim[0], rim[1], rim[2];
    return;
  }
  Eigen::RowVector3d middle = Eigen::RowVector3d::Zero();
  for (const int v : rim) middle += mesh.V.row(v) / count;
  const auto center = static_cast<int>(mesh.V.rows());
  mesh.V.conservativeResize(center + 1, 3);
  mesh.V.row(center) = middle;
  mesh.F.conservativeResize(first + count, 3);
  for (int i = 0; i < count; ++i) mesh.F.row(first + i) << rim[i], rim[(i + 1) % count], center;
}

}  // namespace

std::string Mending::Text() const {
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : "; ") + part; };
  if (merged_corners > 0) {
    add(fmt::format("{} merged with {} beside {}",
                    merged_corners == 1 ? "1 corner" : fmt::format("{} corners", merged_corners),
                    merged_corners == 1 ? "one" : "ones", merged_corners == 1 ? "it" : "them"));
  }
  if (dropped_faces > 0) {
    add(fmt::format("{} given twice left out",
                    dropped_faces == 1 ? "1 face" : fmt::format("{} faces", dropped_faces)));
  }
  if (closed_holes > 0) {
    add(fmt::format("{} {:.2g} mm across",
                    closed_holes == 1 ? "1 hole closed,"
                                      : fmt::format("{} holes closed, the largest", closed_holes),
                    1e3 * largest_hole));
  }
  return text;
}

Mending MendMesh(TriangleMesh& mesh) {
  Mending mending;
  mending.merged_corners = MergeCorners(mesh);
  mending.dropped_faces = DropRepeatedFaces(mesh);
  const double tiny = kTinyHole * Diagonal(mesh);
  for (const std::vector<int>& rim : FindRims(mesh)) {
    AlignedBox bounds;
    for (const int v : rim) bounds.extend(Vector3(mesh.V.row(v)));
    const double across = bounds.sizes().maxCoeff();
    if (across > tiny) continue;
    Close(mesh, rim);
    ++mending.closed_holes;
    mending.largest_hole = std::max(mending.largest_hole, across);
  }
  return mending;
}

}  // namespace pregrasp
