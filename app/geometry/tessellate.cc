#include "app/geometry/tessellate.h"

#include <cmath>
#include <vector>

#include "app/core/check.h"
#include "app/geometry/mesh_topology.h"

namespace pregrasp {
namespace {

TriangleMesh TessellateBox(const Box& box) {
  TriangleMesh mesh;
  mesh.V.resize(8, 3);
  for (int v = 0; v < 8; ++v) {  // bit i of v: the far side along axis i
    for (int i = 0; i < 3; ++i) mesh.V(v, i) = ((v >> i) & 1 ? 0.5 : -0.5) * box.size[i];
  }
  mesh.F.resize(12, 3);
  mesh.F << 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3,
      1, 4, 5, 7, 4, 7, 6;
  return mesh;
}

// A surface of revolution about z from rings (radius, z), bottom to top, between two poles.
TriangleMesh Revolve(const std::vector<Vector2>& rings, double z_bottom, double z_top,
                     int segments) {
  const int num_rings = static_cast<int>(rings.size());
  TriangleMesh mesh;
  mesh.V.resize(num_rings * segments + 2, 3);
  for (int r = 0; r < num_rings; ++r) {
    for (int s = 0; s < segments; ++s) {
      const double angle = 2.0 * kPi * s / segments;
      mesh.V.row(r * segments + s) << rings[r].x() * std::cos(angle),
          rings[r].x() * std::sin(angle), rings[r].y();
    }
  }
  const int bottom = num_rings * segments, top = bottom + 1;
  mesh.V.row(bottom) << 0.0, 0.0, z_bottom;
  mesh.V.row(top) << 0.0, 0.0, z_top;
  const int num_faces = 2 * segments * num_rings;
  mesh.F.resize(num_faces, 3);
  int f = 0;
  for (int s = 0; s < segments; ++s) {
    const int next = (s + 1) % segments;
    mesh.F.row(f++) << bottom, next, s;
    for (int r = 0; r + 1 < num_rings; ++r) {
      const int below = r * segments, above = (r + 1) * segments;
      mesh.F.row(f++) << below + s, below + next, above + next;
      mesh.F.row(f++) << below + s, above + next, above + s;
    }
    const int last = (num_rings - 1) * segments;
    mesh.F.row(f++) << top, last + s, last + next;
  }
  return mesh;
}

// Rings of a ball of radius r cut at its equator, which lies at z = -half and +half.
TriangleMesh TessellateRound(double radius, double half, int segments) {
  const int quarter = std::max(2, segments / 4);
  std::vector<Vector2> rings;
  for (int i = 1; i <= quarter; ++i) {
    const double angle = 0.5 * kPi * i / quarter;
    rings.emplace_back(radius * std::sin(angle), -half - radius * std::cos(angle));
  }
  const int lower = static_cast<int>(rings.size());
  for (int i = half > 0.0 ? lower - 1 : lower - 2; i >= 0; --i) {
    rings.emplace_back(rings[i].x(), -rings[i].y());
  }
  return Revolve(rings, -half - radius, half + radius, segments);
}

struct Tessellator {
  int segments;

  TriangleMesh operator()(const Box& box) const { return TessellateBox(box); }
  TriangleMesh operator()(const Cylinder& cylinder) const {
    const double half = 0.5 * cylinder.height;
    return Revolve({{cylinder.radius, -half}, {cylinder.radius, half}}, -half, half, segments);
  }
  TriangleMesh operator()(const Capsule& capsule) const {
    return TessellateRound(capsule.radius, 0.5 * capsule.height, segments);
  }
  TriangleMesh operator()(const Sphere& sphere) const {
    return TessellateRound(sphere.radius, 0.0, segments);
  }
  TriangleMesh operator()(const Mesh& mesh) const { return Loaded(mesh.mesh); }
  TriangleMesh operator()(const Cloud& cloud) const { return Loaded(cloud.mesh); }
  TriangleMesh operator()(const Union& whole) const {
    TriangleMesh mesh;
    for (const PlacedShape& part : whole.parts) {
      AppendMesh(mesh, Transformed(std::visit(*this, part.shape), part.X_BP));
    }
    return mesh;
  }

  static const TriangleMesh& Loaded(const TriangleMesh& mesh) {
    PREGRASP_CHECK(mesh.F.rows() > 0, "shape is not loaded");
    return mesh;
  }
};

}  // namespace

TriangleMesh Tessellate(const Shape& shape, int segments) {
  PREGRASP_CHECK(segments >= 3, segments);
  return std::visit(Tessellator{segments}, shape);
}

}  // namespace pregrasp
