#include "app/dynamics/manifold.h"

#include <algorithm>
#include <cmath>

namespace pregrasp {
namespace {

// Depths [m] closer than this count as equal: below it the choice would follow rounding errors.
constexpr double kDepthTie = 2e-6;
// Relative difference below which two distances or areas count as equal.
constexpr double kSizeTie = 1e-6;
// Twice the area of a triangle that holds nothing [m^2].
constexpr double kMinArea = 1e-14;

// Twice the signed area of triangle (a, b, c).
double Area(const PlanarPoint& a, const PlanarPoint& b, const PlanarPoint& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

}  // namespace

Approach::Approach(const PlacedConvex& a, const PlacedConvex& b, const Vector3& p_WO,
                   const Matrix3& R_WT) {
  const Vector3 turn = b.turn_W - a.turn_W;
  const Vector3 shift =
      b.shift_W + b.turn_W.cross(p_WO - b.p_WP) - a.shift_W - a.turn_W.cross(p_WO - a.p_WP);
  const Vector3 nhat = R_WT.col(2);
  at_origin = nhat.dot(shift);
  per_x = nhat.dot(turn.cross(R_WT.col(0)));
  per_y = nhat.dot(turn.cross(R_WT.col(1)));
}

int ChooseFour(const PlanarPoint* points, int count, const Approach& approach,
               std::array<int, Manifold::kMaxPoints>* chosen) {
  if (count <= Manifold::kMaxPoints) {
    for (int i = 0; i < count; ++i) (*chosen)[i] = i;
    return count;
  }
  int first = 0;
  double lowest = points[0].phi + approach.At(points[0].x, points[0].y);
  for (int i = 1; i < count; ++i) {
    const double gap = points[i].phi + approach.At(points[i].x, points[i].y);
    if (gap < lowest - kDepthTie) {
      lowest = gap;
      first = i;
    }
  }
  const PlanarPoint& p0 = points[first];
  int second = -1;
  double farthest = 0.0;
  for (int i = 0; i < count; ++i) {
    const double dx = points[i].x - p0.x, dy = points[i].y - p0.y;
    const double distance2 = dx * dx + dy * dy;
    if (distance2 > farthest * (1.0 + kSizeTie)) {
      farthest = distance2;
      second = i;
    }
  }
  (*chosen)[0] = first;
  if (second < 0) return 1;
  (*chosen)[1] = second;
  const PlanarPoint& p1 = points[second];

  int third = -1;
  double third_area = 0.0;
  for (int i = 0; i < count; ++i) {
    const double area = Area(p0, p1, points[i]);
    if (std::abs(area) > std::abs(third_area) * (1.0 + kSizeTie) + kMinArea) {
      third_area = area;
      third = i;
    }
  }
  if (third < 0) return 2;
  (*chosen)[2] = third;
  const PlanarPoint& p2 = points[third];

  const double sign = third_area > 0.0 ? 1.0 : -1.0;
  int fourth = -1;
  double fourth_area = kMinArea;
  for (int i = 0; i < count; ++i) {
    const PlanarPoint& p = points[i];
    const double outside =
        -std::min({sign * Area(p0, p1, p), sign * Area(p1, p2, p), sign * Area(p2, p0, p)});
    if (outside > fourth_area * (1.0 + kSizeTie)) {
      fourth_area = outside;
      fourth = i;
    }
  }
  if (fourth < 0) return 3;
  (*chosen)[3] = fourth;
  return 4;
}

}  // namespace pregrasp
