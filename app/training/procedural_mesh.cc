#include "app/training/procedural_mesh.h"

#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>

#include "app/core/check.h"

namespace pregrasp {

TriangleMesh SkinRings(const std::vector<Ring>& rings) {
  PREGRASP_CHECK(rings.size() >= 2 && rings[0].size() >= 3, rings.size());
  const auto n = std::ssize(rings[0]), m = std::ssize(rings);
  TriangleMesh mesh;
  mesh.V.resize(n * m + 2, 3);
  mesh.F.resize(2 * n * m, 3);
  for (std::ptrdiff_t i = 0; i < m; ++i) {
    PREGRASP_CHECK(std::ssize(rings[i]) == n, rings[i].size(), n);
    for (std::ptrdiff_t j = 0; j < n; ++j) mesh.V.row(i * n + j) = rings[i][j].transpose();
  }
  const auto bottom = static_cast<int>(n * m), top = bottom + 1;
  mesh.V.row(bottom) = mesh.V.topRows(n).colwise().mean();
  mesh.V.row(top) = mesh.V.middleRows(n * (m - 1), n).colwise().mean();
  int face = 0;
  const auto index = [&](std::ptrdiff_t i, std::ptrdiff_t j) {
    return static_cast<int>(i * n + j % n);
  };
  for (std::ptrdiff_t j = 0; j < n; ++j) {
    mesh.F.row(face++) << bottom, index(0, j + 1), index(0, j);
    for (std::ptrdiff_t i = 0; i + 1 < m; ++i) {
      mesh.F.row(face++) << index(i, j), index(i, j + 1), index(i + 1, j + 1);
      mesh.F.row(face++) << index(i, j), index(i + 1, j + 1), index(i + 1, j);
    }
    mesh.F.row(face++) << top, index(m - 1, j), index(m - 1, j + 1);
  }
  return mesh;
}

TriangleMesh Lathe(const std::vector<Vector2>& profile, int segments) {
  std::vector<Ring> rings;
  for (const Vector2& point : profile) {
    PREGRASP_CHECK(point.x() > 0.0, point.x());
    Ring ring;
    for (int j = 0; j < segments; ++j) {
      const double angle = 2.0 * kPi * j / segments;
      ring.emplace_back(point.x() * std::cos(angle), point.x() * std::sin(angle), point.y());
    }
    rings.push_back(std::move(ring));
  }
  return SkinRings(rings);
}

Ring RoundedRectangle(double x, double y, double radius, double z) {
  constexpr int kPerCorner = 5;
  PREGRASP_CHECK(radius > 0.0 && 2.0 * radius <= std::min(x, y) * (1.0 + 1e-12), radius, x, y);
  Ring ring;
  for (int corner = 0; corner < 4; ++corner) {
    const double sx = corner == 0 || corner == 3 ? 1.0 : -1.0, sy = corner < 2 ? 1.0 : -1.0;
    for (int k = 0; k < kPerCorner; ++k) {
      const double angle = 0.5 * kPi * (corner + k / (kPerCorner - 1.0));
      ring.emplace_back(sx * (0.5 * x - radius) + radius * std::cos(angle),
                        sy * (0.5 * y - radius) + radius * std::sin(angle), z);
    }
  }
  return ring;
}

Mesh MakeMeshShape(TriangleMesh mesh) {
  Mesh shape;
  shape.mesh = std::move(mesh);
  return shape;
}

}  // namespace pregrasp
