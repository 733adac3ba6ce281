#include "app/geometry/sharp_edges.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/geometry/mesh_topology.h"

namespace pregrasp {
namespace {

constexpr double kRimStep = kPi / 36.0;  // [rad], of a rim's turn
constexpr double kSameNormal = 1e-6;     // [rad], nearer ones count once, or as opposite

bool AreOpposite(const Vector3& nhat, const Vector3& other) {
  return (nhat + other).norm() < kSameNormal;
}

class Finder {
 public:
  Finder(double spacing, double least_angle) : spacing_(spacing), least_angle_(least_angle) {}

  std::vector<EdgePoint> Find(const Shape& shape) {
    std::visit(*this, shape);
    return std::move(points_);
  }

  void operator()(const Box& box) {
    const Vector3 half = 0.5 * box.size;
    const auto corner = [&](int signs) {
      return Vector3((signs & 1 ? half.x() : -half.x()), (signs & 2 ? half.y() : -half.y()),
                     (signs & 4 ? half.z() : -half.z()));
    };
    for (int axis = 0; axis < 3; ++axis) {
      for (int signs = 0; signs < 8; ++signs) {
        if (signs & (1 << axis)) continue;
        const Vector3 a = corner(signs), b = corner(signs | (1 << axis));
        EdgePoint edge;
        for (int k = 0; k < 3; ++k) {
          if (k != axis) edge.nhats_B.push_back((a[k] > 0.0 ? 1.0 : -1.0) * Vector3::Unit(k));
        }
        AddAlong(a, b, edge);
      }
    }
    for (int signs = 0; signs < 8; ++signs) {
      EdgePoint point{corner(signs), {}};
      for (int k = 0; k < 3; ++k) {
        point.nhats_B.push_back((point.p_B[k] > 0.0 ? 1.0 : -1.0) * Vector3::Unit(k));
      }
      points_.push_back(std::move(point));
    }
  }

  void operator()(const Cylinder& cylinder) {
    const double step = std::min(kRimStep, spacing_ / cylinder.radius);
    const int count = static_cast<int>(std::ceil(2.0 * kPi / step - 1e-9));
    for (const double up : {-1.0, 1.0}) {
      for (int i = 0; i < count; ++i) {
        const double angle = 2.0 * kPi * i / count;
        const Vector3 radial(std::cos(angle), std::sin(angle), 0.0);
        const Vector3 axial(0.0, 0.0, up);
        points_.push_back(
            {cylinder.radius * radial + 0.5 * cylinder.height * axial, {radial, axial}});
      }
    }
  }

  void operator()(const Capsule&) {}
  void operator()(const Sphere&) {}
  void operator()(const Mesh& mesh) { AddMesh(mesh.mesh); }
  void operator()(const Cloud& cloud) { AddMesh(cloud.mesh); }

  void operator()(const Union& whole) {
    for (const PlacedShape& part : whole.parts) {
      for (EdgePoint& point : Finder(spacing_, least_angle_).Find(part.shape)) {
        point.p_B = part.X_BP * point.p_B;
        for (Vector3& nhat : point.nhats_B) nhat = part.X_BP.linear() * nhat;
        points_.push_back(std::move(point));
      }
    }
  }

 private:
  // The points between a and b.
  void AddAlong(const Vector3& a, const Vector3& b, EdgePoint edge) {
    const int count = static_cast<int>(std::ceil((b - a).norm() / spacing_ - 1e-9));
    for (int i = 1; i < count; ++i) {
      edge.p_B = a + (static_cast<double>(i) / count) * (b - a);
      points_.push_back(edge);
    }
  }

  void AddMesh(const TriangleMesh& mesh) {
    const std::vector<std::array<int, 3>> neighbours = FindNeighbours(mesh);
    const std::vector<Vector3> nhats = CalcFaceNormals(mesh, neighbours);
    const double cosine = std::cos(least_angle_);
    std::vector<int> first_face(mesh.V.rows(), -1);  // of the vertices of these edges
    for (int f = 0; f < mesh.F.rows(); ++f) {
      for (int i = 0; i < 3; ++i) {
        const int g = neighbours[f][i];
        if (g < 0 || nhats[f].dot(nhats[g]) >= cosine) continue;
        if (nhats[f].isZero(0.0) || nhats[g].isZero(0.0)) continue;
        const int v = mesh.F(f, i), w = mesh.F(f, (i + 1) % 3);
        const Vector3 a = mesh.V.row(v), b = mesh.V.row(w);
        const bool folded = AreOpposite(nhats[f], nhats[g]);
        if (!folded && nhats[f].cross(nhats[g]).dot(b - a) < 0.0) continue;  // hollow
        first_face[v] = f;
        if (f > g) continue;
        if (folded) {  // a sheet's rim: the arc leads around by way of where the sheet ends
          const Vector3 away = (b - a).cross(nhats[f]).normalized();
          AddAlong(a, b, {a, {nhats[f], away}});
          AddAlong(a, b, {a, {away, nhats[g]}});
        } else {
          AddAlong(a, b, {a, {nhats[f], nhats[g]}});
        }
      }
    }
    for (int v = 0; v < mesh.V.rows(); ++v) {
      if (first_face[v] < 0) continue;
      EdgePoint point{mesh.V.row(v), CollectNormals(mesh, neighbours, nhats, v, first_face[v])};
      std::vector<Vector3>& around = point.nhats_B;
      if (around.size() < 2) continue;
      if (around.size() == 2 && AreOpposite(around[0], around[1])) {
        around.insert(around.begin() + 1, around[0].unitOrthogonal());  // which way is not told
      }
      points_.push_back(std::move(point));
    }
  }

  // Of the faces around a vertex, in order, those like the one before left out.
  static std::vector<Vector3> CollectNormals(const TriangleMesh& mesh,
                                             const std::vector<std::array<int, 3>>& neighbours,
                                             const std::vector<Vector3>& nhats, int vertex,
                                             int first) {
    std::vector<Vector3> around;
    int face = first;
    do {
      const Vector3& nhat = nhats[face];
      const bool new_one = around.empty() || (around.back() - nhat).norm() > kSameNormal;
      if (new_one && !nhat.isZero(0.0)) around.push_back(nhat);
      int corner = 0;
      while (mesh.F(face, corner) != vertex) ++corner;
      face = neighbours[face][(corner + 2) % 3];
    } while (face >= 0 && face != first);
    while (around.size() > 1 && (around.back() - around.front()).norm() <= kSameNormal) {
      around.pop_back();
    }
    return around;
  }

  double spacing_, least_angle_;
  std::vector<EdgePoint> points_;
};

}  // namespace

std::vector<EdgePoint> FindEdgePoints(const Shape& shape, double spacing, double least_angle) {
  return Finder(spacing, least_angle).Find(shape);
}

}  // namespace pregrasp
