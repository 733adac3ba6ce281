#include "app/geometry/point_hull.h"

#include <algorithm>
#include <vector>

#include "app/geometry/hull.h"

namespace pregrasp {

PointHull::PointHull(const SampledCloud& cloud)
    : distance_(CalcConvexHull(cloud.P)),
      index_(cloud.P, 2.0 * cloud.spacing),
      N_(cloud.N),
      spacing_(cloud.spacing) {}

void PointHull::PullIn(TriangleMesh& mesh) const {
  constexpr double kAlongNormal = 0.05, kAcross = 0.4, kSlope = 1.2;  // in spacings
  constexpr int kFew = 8;
  std::vector<int> found;
  for (int v = 0; v < mesh.V.rows(); ++v) {
    const Vector3 p = mesh.V.row(v);
    if (distance_.Calc(p) <= kAlongNormal * spacing_) continue;
    const NearestPoint nearest = distance_.FindNearest(p);
    const Vector3 out = (p - nearest.p_B) / nearest.distance;
    index_.FindNearest(nearest.p_B, kFew, found);
    double cos_most = 0.0;
    for (const int i : found) cos_most = std::max(cos_most, out.dot(N_.row(i)));
    const double limit = spacing_ * std::min(kAlongNormal + kSlope * (1.0 - cos_most), kAcross);
    if (nearest.distance > limit) mesh.V.row(v) = nearest.p_B + limit * out;
  }
}

}  // namespace pregrasp
