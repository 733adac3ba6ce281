#include "render/mesh_surface.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "app/core/check.h"

namespace pregrasp {
namespace {

std::array<float, 3> ToFloat(const Vector3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

Vector3 FaceNormal(const TriangleMesh& mesh, Eigen::Index f) {
  const Vector3 a = mesh.V.row(mesh.F(f, 0)), b = mesh.V.row(mesh.F(f, 1)),
                c = mesh.V.row(mesh.F(f, 2));
  const Vector3 n = (b - a).cross(c - a);
  const double length = n.norm();
  return length > 0.0 ? Vector3(n / length) : Vector3(Vector3::Zero());
}

MatrixX3 FaceNormals(const TriangleMesh& mesh) {
  MatrixX3 N(mesh.F.rows(), 3);
  for (Eigen::Index f = 0; f < mesh.F.rows(); ++f) N.row(f) = FaceNormal(mesh, f);
  return N;
}

void CheckIndices(const TriangleMesh& mesh) {
  if (mesh.F.rows() == 0) return;
  PREGRASP_CHECK(mesh.F.minCoeff() >= 0 && mesh.F.maxCoeff() < mesh.V.rows(), mesh.F.minCoeff(),
                 mesh.F.maxCoeff(), mesh.V.rows());
  PREGRASP_CHECK(mesh.V.allFinite());
}

// For each vertex, the lowest index of a vertex at exactly the same place.
std::vector<int> WeldVertices(const MatrixX3& V) {
  std::vector<int> order(V.rows()), weld(V.rows());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&V](int i) { return std::make_tuple(V(i, 0), V(i, 1), V(i, 2), i); };
  std::sort(order.begin(), order.end(), [&key](int a, int b) { return key(a) < key(b); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && V.row(order[i]) == V.row(order[i - 1]);
    weld[order[i]] = same ? weld[order[i - 1]] : order[i];
  }
  return weld;
}

double CornerAngle(const TriangleMesh& mesh, Eigen::Index f, int corner) {
  const Vector3 p = mesh.V.row(mesh.F(f, corner));
  const Vector3 u = mesh.V.row(mesh.F(f, (corner + 1) % 3)).transpose() - p;
  const Vector3 v = mesh.V.row(mesh.F(f, (corner + 2) % 3)).transpose() - p;
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

ShadedSurface BuildFlat(const TriangleMesh& mesh, const MatrixX3& N) {
  ShadedSurface surface;
  surface.vertices.reserve(3 * mesh.F.rows());
  for (Eigen::Index f = 0; f < mesh.F.rows(); ++f) {
    for (int corner = 0; corner < 3; ++corner) {
      surface.indices.push_back(static_cast<std::uint32_t>(surface.vertices.size()));
      surface.vertices.push_back({ToFloat(mesh.V.row(mesh.F(f, corner))), ToFloat(N.row(f))});
    }
  }
  return surface;
}

}  // namespace

ShadedSurface BuildShadedSurface(const TriangleMesh& mesh, bool smooth) {
  CheckIndices(mesh);
  const MatrixX3 N = FaceNormals(mesh);
  if (!smooth) return BuildFlat(mesh, N);
  const std::vector<int> weld = WeldVertices(mesh.V);
  std::vector<std::vector<std::pair<Eigen::Index, double>>> corners(mesh.V.rows());
  for (Eigen::Index f = 0; f < mesh.F.rows(); ++f) {
    for (int corner = 0; corner < 3; ++corner) {
      corners[weld[mesh.F(f, corner)]].emplace_back(f, CornerAngle(mesh, f, corner));
    }
  }
  ShadedSurface surface;
  std::map<std::pair<int, std::array<float, 3>>, std::uint32_t> known;
  const double cos_crease = std::cos(kCreaseAngle);
  for (Eigen::Index f = 0; f < mesh.F.rows(); ++f) {
    for (int corner = 0; corner < 3; ++corner) {
      const int vertex = weld[mesh.F(f, corner)];
      Vector3 n = Vector3::Zero();
      for (const auto& [other, angle] : corners[vertex]) {
        if (N.row(other).dot(N.row(f)) > cos_crease) n += angle * N.row(other).transpose();
      }
      const std::array<float, 3> normal =
          ToFloat(n.norm() > 0.0 ? n.normalized() : Vector3(N.row(f)));
      const auto [at, added] = known.emplace(std::make_pair(vertex, normal),
                                             static_cast<std::uint32_t>(surface.vertices.size()));
      if (added) surface.vertices.push_back({ToFloat(mesh.V.row(vertex)), normal});
      surface.indices.push_back(at->second);
    }
  }
  return surface;
}

bool IsClosedMesh(const TriangleMesh& mesh) {
  CheckIndices(mesh);
  const std::vector<int> weld = WeldVertices(mesh.V);
  std::vector<std::pair<int, int>> along, against;
  for (Eigen::Index f = 0; f < mesh.F.rows(); ++f) {
    for (int corner = 0; corner < 3; ++corner) {
      const int a = weld[mesh.F(f, corner)], b = weld[mesh.F(f, (corner + 1) % 3)];
      if (a == b) continue;
      along.emplace_back(a, b);
      against.emplace_back(b, a);
    }
  }
  std::sort(along.begin(), along.end());
  std::sort(against.begin(), against.end());
  return !along.empty() && along == against;
}

std::vector<ShadedEdge> BuildShadedEdges(const TriangleMesh& mesh, bool creases_only) {
  CheckIndices(mesh);
  const MatrixX3 N = FaceNormals(mesh);
  const std::vector<int> weld = WeldVertices(mesh.V);
  std::map<std::pair<int, int>, std::vector<Eigen::Index>> faces;
  for (Eigen::Index f = 0; f < mesh.F.rows(); ++f) {
    for (int corner = 0; corner < 3; ++corner) {
      const int a = weld[mesh.F(f, corner)], b = weld[mesh.F(f, (corner + 1) % 3)];
      if (a != b) faces[std::minmax(a, b)].push_back(f);
    }
  }
  std::vector<ShadedEdge> edges;
  for (const auto& [ends, around] : faces) {
    const Vector3 n = N.row(around.front()), m = N.row(around.back());
    if (creases_only && around.size() == 2) {
      const Vector3 middle = 0.5 * (mesh.V.row(ends.first) + mesh.V.row(ends.second));
      const Vector3 inward = mesh.V.row(mesh.F(around[0], 0)) + mesh.V.row(mesh.F(around[0], 1)) +
                             mesh.V.row(mesh.F(around[0], 2));
      const bool convex = m.dot(inward / 3.0 - middle) <= 0.0;
      if (!convex || n.dot(m) > std::cos(kCreaseAngle)) continue;
    }
    edges.push_back({ToFloat(mesh.V.row(ends.first)), ToFloat(mesh.V.row(ends.second)), ToFloat(n),
                     ToFloat(m)});
  }
  return edges;
}

namespace {

// Stacks of rings about z, each (radius, z), closed by fans where a radius is 0.
TriangleMesh Revolve(const std::vector<Vector2>& profile, int segments) {
  TriangleMesh mesh;
  const auto rings = static_cast<int>(profile.size());
  mesh.V.resize(static_cast<Eigen::Index>(rings) * segments, 3);
  for (int i = 0; i < rings; ++i) {
    for (int k = 0; k < segments; ++k) {
      const double angle = 2.0 * kPi * k / segments;
      mesh.V.row(i * segments + k) << profile[i].x() * std::cos(angle),
          profile[i].x() * std::sin(angle), profile[i].y();
    }
  }
  std::vector<Eigen::Vector3i> faces;
  for (int i = 0; i + 1 < rings; ++i) {
    for (int k = 0; k < segments; ++k) {
      const int a = i * segments + k, b = i * segments + (k + 1) % segments;
      if (profile[i].x() > 0.0) faces.emplace_back(a, b, b + segments);
      if (profile[i + 1].x() > 0.0) faces.emplace_back(a, b + segments, a + segments);
    }
  }
  mesh.F.resize(static_cast<Eigen::Index>(faces.size()), 3);
  for (std::size_t f = 0; f < faces.size(); ++f)
    mesh.F.row(static_cast<Eigen::Index>(f)) = faces[f];
  return mesh;
}

}  // namespace

TriangleMesh UnitCylinder(int segments) {
  return Revolve({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, segments);
}

TriangleMesh UnitCone(int segments) { return Revolve({{0, 0}, {1, 0}, {0, 1}}, segments); }

TriangleMesh UnitOpenCone(int segments) { return Revolve({{0, 0}, {1, 1}}, segments); }

TriangleMesh UnitBall(int subdivisions) {
  const int rings = 4 << subdivisions;
  std::vector<Vector2> profile;
  for (int i = 0; i <= rings; ++i) {
    const double angle = kPi * i / rings;
    const bool pole = i == 0 || i == rings;
    profile.emplace_back(pole ? 0.0 : std::sin(angle), -std::cos(angle));
  }
  return Revolve(profile, 2 * rings);
}

}  // namespace pregrasp
