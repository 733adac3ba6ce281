#include "app/geometry/mesh_cut.h"

#include <algorithm>
#include <cmath>

namespace pregrasp {
namespace {

void ClipBelow(const Triangle& t, const Plane& plane, double snap, std::vector<Triangle>& out) {
  std::array<double, 3> height{};
  int above = 0, below = 0;
  for (int i = 0; i < 3; ++i) {
    height[i] = plane.Height(t[i]);
    if (std::abs(height[i]) < snap) height[i] = 0.0;
    if (height[i] > 0.0) ++above;
    if (height[i] < 0.0) ++below;
  }
  if (above == 0 && below == 0) {
    if ((t[1] - t[0]).cross(t[2] - t[0]).dot(plane.nhat) > 0.0) out.push_back(t);
    return;
  }
  if (below == 0) return;
  if (above == 0) {
    out.push_back(t);
    return;
  }
  std::array<Vector3, 4> polygon;
  int corners = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    if (height[i] <= 0.0) polygon[corners++] = t[i];
    if (height[i] * height[j] < 0.0) {
      // From the lower end always, so that both triangles at an edge get the same point.
      const int low = height[i] < 0.0 ? i : j, high = low == i ? j : i;
      const double s = height[low] / (height[low] - height[high]);
      polygon[corners++] = t[low] + s * (t[high] - t[low]);
    }
  }
  for (int i = 2; i < corners; ++i) out.push_back({polygon[0], polygon[i - 1], polygon[i]});
}

}  // namespace

SolidPart MakeSolidPart(const TriangleMesh& mesh) {
  SolidPart part;
  part.surface.resize(mesh.F.rows());
  for (int f = 0; f < mesh.F.rows(); ++f) {
    for (int i = 0; i < 3; ++i) part.surface[f][i] = mesh.V.row(mesh.F(f, i));
  }
  return part;
}

SolidPart CutBelow(const SolidPart& part, const Plane& plane, double snap) {
  SolidPart below;
  below.surface.reserve(part.surface.size());
  for (const Triangle& t : part.surface) ClipBelow(t, plane, snap, below.surface);
  below.cell = part.cell;
  below.cell.push_back(plane);
  return below;
}

void AppendHullPoints(const SolidPart& part, const MeshDistance& distance, std::size_t stride,
                      std::vector<Vector3>& points) {
  for (std::size_t f = 0; f < part.surface.size(); f += stride) {
    points.insert(points.end(), part.surface[f].begin(), part.surface[f].end());
  }
  const double size = distance.bounds().sizes().norm();
  const double slack = 1e-9 * size, on_surface = 1e-6 * size;
  const std::vector<Plane>& cell = part.cell;
  for (std::size_t i = 0; i < cell.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      for (std::size_t k = 0; k < j; ++k) {
        Matrix3 N;
        N << cell[i].nhat.transpose(), cell[j].nhat.transpose(), cell[k].nhat.transpose();
        if (std::abs(N.determinant()) < 1e-6) continue;
        const Vector3 p = N.inverse() * Vector3(cell[i].offset, cell[j].offset, cell[k].offset);
        if (!distance.bounds().contains(p)) continue;
        const bool in_cell = std::all_of(
            cell.begin(), cell.end(), [&](const Plane& plane) { return plane.Height(p) <= slack; });
        // On the surface it is the part's only if triangles of the part say so.
        if (in_cell && distance.Calc(p) < -on_surface) points.push_back(p);
      }
    }
  }
}

}  // namespace pregrasp
