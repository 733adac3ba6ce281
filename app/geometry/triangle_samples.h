#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "app/core/rng.h"
#include "app/geometry/mesh_cut.h"

namespace pregrasp {

inline double AreaOf(const Triangle& t) { return 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm(); }

inline Triangle FaceOf(const TriangleMesh& mesh, int f) {
  return {mesh.V.row(mesh.F(f, 0)), mesh.V.row(mesh.F(f, 1)), mesh.V.row(mesh.F(f, 2))};
}

/// A point of a triangle, uniform over its area.
inline Vector3 PointOn(const Triangle& t, Rng& rng) {
  const double s = std::sqrt(rng.Uniform()), u = rng.Uniform();
  return (1.0 - s) * t[0] + s * (1.0 - u) * t[1] + s * u * t[2];
}

/// Calls visit(point) for `count` points spread over triangles by area; `sums` are the running sums
/// of their areas, and triangle(i) is the i-th of them.
template <typename GetTriangle, typename Visit>
void VisitSamples(const std::vector<double>& sums, int count, Rng& rng, GetTriangle&& triangle,
                  Visit&& visit) {
  for (int i = 0; i < count; ++i) {
    const double at = (i + rng.Uniform()) / count * sums.back();
    const auto it = std::lower_bound(sums.begin(), sums.end() - 1, at);
    visit(PointOn(triangle(static_cast<int>(it - sums.begin())), rng));
  }
}

}  // namespace pregrasp
