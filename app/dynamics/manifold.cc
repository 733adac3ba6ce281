#include "app/dynamics/manifold.h"

#include <algorithm>

namespace pregrasp {
namespace {

// Depths [m] closer than this count as equal: below it the choice would follow rounding errors.
constexpr double kDepthTie = 2e-6;
// Relative difference below which two distances or areas count as equal.
constexpr double kSizeTie = 1e-6;

}  // namespace

void ReduceToFour(const ManifoldPoint* points, int count, Manifold* manifold) {
  manifold->size = 0;
  if (count <= Manifold::kMaxPoints) {
    std::copy_n(points, count, manifold->points.begin());
    manifold->size = count;
    return;
  }
  const Vector3& n = manifold->nhat_W;
  int first = 0;
  for (int i = 1; i < count; ++i) {
    if (points[i].phi < points[first].phi - kDepthTie) first = i;
  }
  const Vector3 p0 = points[first].p_W;
  const auto tangential = [&n](const Vector3& r) -> Vector3 { return r - n * n.dot(r); };

  int second = -1;
  double best = 0.0;
  for (int i = 0; i < count; ++i) {
    const double distance = tangential(points[i].p_W - p0).squaredNorm();
    if (distance > best * (1.0 + kSizeTie)) {
      best = distance;
      second = i;
    }
  }
  manifold->points[manifold->size++] = points[first];
  if (second < 0) return;
  manifold->points[manifold->size++] = points[second];
  const Vector3 p1 = points[second].p_W;

  // Twice the signed area of (p0, p1, p) seen against the normal.
  const auto area = [&n](const Vector3& a, const Vector3& b, const Vector3& c) {
    return n.dot((b - a).cross(c - a));
  };
  int third = -1;
  double third_area = 0.0;
  for (int i = 0; i < count; ++i) {
    const double a = area(p0, p1, points[i].p_W);
    if (std::abs(a) > std::abs(third_area) * (1.0 + kSizeTie) + 1e-14) {
      third_area = a;
      third = i;
    }
  }
  if (third < 0) return;
  manifold->points[manifold->size++] = points[third];
  const Vector3 p2 = points[third].p_W;

  const double sign = third_area > 0.0 ? 1.0 : -1.0;
  int fourth = -1;
  double fourth_area = 1e-14;
  for (int i = 0; i < count; ++i) {
    const Vector3& p = points[i].p_W;
    const double outside =
        std::max({-sign * area(p0, p1, p), -sign * area(p1, p2, p), -sign * area(p2, p0, p)});
    if (outside > fourth_area * (1.0 + kSizeTie)) {
      fourth_area = outside;
      fourth = i;
    }
  }
  if (fourth >= 0) manifold->points[manifold->size++] = points[fourth];
}

}  // namespace pregrasp
