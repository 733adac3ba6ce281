#include "app/geometry/contact_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "app/core/check.h"
#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/geometry/hull.h"
#include "app/geometry/iso_surface.h"
#include "app/geometry/mass_properties.h"
#include "app/geometry/mesh_distance.h"
#include "app/geometry/mesh_topology.h"
#include "app/geometry/signed_distance.h"
#include "app/geometry/simplify.h"
#include "app/geometry/tessellate.h"

namespace pregrasp {
namespace {

constexpr int kSegments = 64;         // of round primitives before they are simplified
constexpr int kFineTriangles = 24;    // before simplifying, for each triangle wanted
constexpr int kUnionNodes = 100'000;  // of the grid on which a union becomes one surface

// Splits faces until triangles are so many and even that collapsing them can place the few freely.
TriangleMesh Refine(const TriangleMesh& mesh, int triangles) {
  const double area = CalcArea(mesh) / (kFineTriangles * triangles);
  // The edge of an equilateral triangle of that area, and a half more: bisection leaves edges
  // between that and half of it.
  return SplitLongEdges(mesh, 1.5 * std::sqrt(4.0 / std::sqrt(3.0) * area));
}

// Points on the hull of `mesh`'s vertices become corners of it: those that lie inside or in a flat
// face are put into the face nearest to them. Every corner adds two triangles wherever it is put,
// so a closed ball keeps its number of faces.
class ConvexRebuild {
 public:
  explicit ConvexRebuild(const MatrixX3& V)
      : tolerance_(1e-6 * (V.colwise().maxCoeff() - V.colwise().minCoeff()).maxCoeff()) {
    mesh_ = CalcConvexHull(FindCorners(V));
    const MatrixX3 corners = mesh_.V;
    for (int v = 0; v < V.rows(); ++v) {
      ThrowIfInterrupted();
      const bool used = (corners.rowwise() - V.row(v)).rowwise().squaredNorm().minCoeff() == 0.0;
      if (!used) Insert(V.row(v));
    }
    FlipFlatEdges(mesh_, 1e-5);
  }

  TriangleMesh mesh_;

 private:
  // The points that span the hull: each lies outside the hull of the others.
  MatrixX3 FindCorners(const MatrixX3& V) const {
    MatrixX3 corners = CalcReducedHull(V, tolerance_, static_cast<int>(V.rows())).V;
    for (int v = 0; v < corners.rows() && corners.rows() > 4;) {
      ThrowIfInterrupted();
      MatrixX3 others(corners.rows() - 1, 3);
      others << corners.topRows(v), corners.bottomRows(corners.rows() - 1 - v);
      if (CalcHeightAbove(others, corners.row(v)) > tolerance_) {
        ++v;
      } else {
        corners = others;
      }
    }
    return corners;
  }

  // How far p lies outside the hull of the points; far when they have none.
  static double CalcHeightAbove(const MatrixX3& points, const Vector3& p) {
    try {
      const TriangleMesh hull = CalcConvexHull(points);
      double height = -std::numeric_limits<double>::infinity();
      for (int f = 0; f < hull.F.rows(); ++f) {
        const Vector3 a = hull.V.row(hull.F(f, 0)), b = hull.V.row(hull.F(f, 1)),
                      c = hull.V.row(hull.F(f, 2));
        height = std::max(height, (b - a).cross(c - a).normalized().dot(p - a));
      }
      return height;
    } catch (const InputError&) {
      return std::numeric_limits<double>::infinity();
    }
  }

  void Insert(const Vector3& p) {
    const NearestPoint nearest = MeshDistance(mesh_).FindNearest(p);
    const int f = nearest.triangle;
    Eigen::Vector3d weight;
    std::array<Vector3, 3> corner;
    for (int i = 0; i < 3; ++i) corner[i] = mesh_.V.row(mesh_.F(f, i));
    const Vector3 n = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    for (int i = 0; i < 3; ++i) {
      weight[i] =
          n.dot((corner[(i + 1) % 3] - nearest.p_B).cross(corner[(i + 2) % 3] - nearest.p_B)) /
          n.squaredNorm();
    }
    int opposite = 0;
    constexpr double kNearEdge = 0.02;  // barycentric; nearer to an edge a sliver would result
    const double smallest = weight.minCoeff(&opposite);
    if (smallest > kNearEdge) {
      SplitFace(f, nearest.p_B);
      return;
    }
    const int a = (opposite + 1) % 3, b = (opposite + 2) % 3;
    const Vector3 edge = corner[b] - corner[a];
    double s = edge.dot(nearest.p_B - corner[a]) / edge.squaredNorm();
    // A point in a corner would double it: it goes to the edge's middle instead.
    if (s < kNearEdge || s > 1.0 - kNearEdge) s = 0.5;
    SplitEdge(f, a, corner[a] + s * edge);
  }

  int AddVertex(const Vector3& p) {
    const auto v = static_cast<int>(mesh_.V.rows());
    mesh_.V.conservativeResize(v + 1, 3);
    mesh_.V.row(v) = p.transpose();
    return v;
  }

  void AddFace(int a, int b, int c) {
    const auto f = static_cast<int>(mesh_.F.rows());
    mesh_.F.conservativeResize(f + 1, 3);
    mesh_.F.row(f) << a, b, c;
  }

  void SplitFace(int f, const Vector3& p) {
    const int a = mesh_.F(f, 0), b = mesh_.F(f, 1), c = mesh_.F(f, 2), v = AddVertex(p);
    mesh_.F.row(f) << a, b, v;
    AddFace(b, c, v);
    AddFace(c, a, v);
  }

  // The edge of face f from its corner `slot`.
  void SplitEdge(int f, int slot, const Vector3& p) {
    const int g = FindNeighbours(mesh_)[f][slot];
    const int a = mesh_.F(f, slot), b = mesh_.F(f, (slot + 1) % 3), c = mesh_.F(f, (slot + 2) % 3);
    int j = 0;
    while (mesh_.F(g, j) != b) ++j;
    const int d = mesh_.F(g, (j + 2) % 3), v = AddVertex(p);
    mesh_.F.row(f) << a, v, c;
    AddFace(v, b, c);
    mesh_.F.row(g) << b, v, d;
    AddFace(v, a, d);
  }

  double tolerance_;
};

TriangleMesh SimplifyConvex(const MatrixX3& points, int triangles) {
  const TriangleMesh hull = CalcConvexHull(points);
  TriangleMesh simple = SimplifyMesh(Refine(hull, triangles), {}, triangles);
  if (simple.F.rows() != triangles) return {};
  return ConvexRebuild(simple.V).mesh_;
}

// Leaves the largest components, so many that each can have eight triangles.
TriangleMesh KeepLargest(const TriangleMesh& mesh, int triangles) {
  const std::vector<int> label = LabelComponents(mesh);
  const int count = 1 + *std::max_element(label.begin(), label.end());
  const int keep = std::max(1, triangles / 8);
  if (count <= keep) return mesh;
  std::vector<std::pair<double, int>> areas(count);
  for (int c = 0; c < count; ++c) areas[c] = {0.0, c};
  for (int f = 0; f < mesh.F.rows(); ++f) {
    const Vector3 a = mesh.V.row(mesh.F(f, 0)), b = mesh.V.row(mesh.F(f, 1)),
                  c = mesh.V.row(mesh.F(f, 2));
    areas[label[f]].first -= (b - a).cross(c - a).norm();
  }
  std::sort(areas.begin(), areas.end());
  std::vector<bool> kept(count, false);
  for (int k = 0; k < keep; ++k) kept[areas[k].second] = true;
  std::vector<bool> keep_face(label.size());
  std::transform(label.begin(), label.end(), keep_face.begin(), [&](int c) { return kept[c]; });
  return TakeFaces(mesh, keep_face);
}

// The outer surface of a union as one mesh, from its signed distance on a grid. The grid rounds
// edges off; the planes, taken from the true surface nearest to each face, let the simplification
// put them back.
TriangleMesh ExtractUnion(const Shape& shape, std::vector<FacePlane>* planes) {
  const SignedDistance distance(shape);
  ScalarGrid grid = MakeGrid(distance.bounds(), kUnionNodes, 2);
  for (int z = 0; z < grid.count[2]; ++z) {
    for (int y = 0; y < grid.count[1]; ++y) {
      ThrowIfInterrupted();
      for (int x = 0; x < grid.count[0]; ++x) {
        grid.values[grid.Index(x, y, z)] = static_cast<float>(distance.Calc(grid.Node(x, y, z)));
      }
    }
  }
  TriangleMesh mesh = ExtractSurface(grid);
  planes->clear();
  for (int f = 0; f < mesh.F.rows(); ++f) {
    ThrowIfInterrupted();
    const Vector3 middle =
        (mesh.V.row(mesh.F(f, 0)) + mesh.V.row(mesh.F(f, 1)) + mesh.V.row(mesh.F(f, 2))) / 3.0;
    FacePlane plane;
    plane.p = distance.Project(middle, &plane.nhat);
    planes->push_back(plane);
  }
  return mesh;
}

TriangleMesh SimplifySurface(const Shape& shape, int triangles) {
  if (!std::holds_alternative<Union>(shape)) {
    const TriangleMesh surface = KeepLargest(Tessellate(shape, kSegments), triangles);
    return SimplifyMesh(Refine(surface, triangles), {}, triangles);
  }
  std::vector<FacePlane> planes;
  const TriangleMesh surface = ExtractUnion(shape, &planes);
  return SimplifyMesh(surface, planes, triangles);
}

}  // namespace

TriangleMesh BuildContactMesh(const Shape& shape, const ContactMeshConfig& config) {
  PREGRASP_CHECK(config.triangles >= 12 && config.triangles % 2 == 0, config.triangles);
  PREGRASP_CHECK(config.convex_share > 0.0 && config.convex_share <= 1.0, config.convex_share);
  const TriangleMesh surface = Tessellate(shape, kSegments);
  const double hull_volume = CalcVolume(CalcConvexHull(surface.V));
  const double volume =
      std::holds_alternative<Union>(shape) ? CalcVolume(shape) : CalcVolume(surface);
  if (volume < config.convex_share * hull_volume) {
    TriangleMesh mesh = SimplifySurface(shape, config.triangles);
    if (mesh.F.rows() == config.triangles) {
      FlipFlatEdges(mesh, 1e-3);
      return mesh;
    }
  }
  TriangleMesh mesh = SimplifyConvex(surface.V, config.triangles);
  PREGRASP_CHECK(mesh.F.rows() == config.triangles, mesh.F.rows(), config.triangles);
  return mesh;
}

}  // namespace pregrasp
