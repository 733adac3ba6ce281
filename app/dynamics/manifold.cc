#include "app/dynamics/manifold.h"

#include <algorithm>
#include <cmath>

namespace pregrasp {
namespace {

// Points that stand for a face.
constexpr int kNumCorners = 4;
// Depths [m] closer than this count as equal: below it the choice would follow rounding errors.
constexpr double kDepthTie = 2e-6;
// Points this near to the plane of the four [m] need not be kept besides them.
constexpr double kInPlane = 1e-7;
// Relative difference below which two distances or areas count as equal.
constexpr double kSizeTie = 1e-6;
// Twice the area of a triangle that holds nothing [m^2].
constexpr double kMinArea = 1e-14;

// A linear function of the tangent plane: twice the signed area of the triangle that a point makes
// with two others.
struct SignedArea {
  double x0, y0, dx, dy;

  SignedArea(const PlanarPoint& from, const PlanarPoint& to)
      : x0(from.x), y0(from.y), dx(to.x - from.x), dy(to.y - from.y) {}
  double At(double x, double y) const { return dx * (y - y0) - dy * (x - x0); }
};

// The first of the largest values, but for ties, that is above `least`; -1 if none is.
int FindLargest(const double* values, int count, double least) {
  int largest = -1;
  double limit = least;
  for (int i = 0; i < count; ++i) {
    if (values[i] <= limit) continue;
    limit = values[i] * (1.0 + kSizeTie) + kMinArea;
    largest = i;
  }
  return largest;
}

// Those of more than four points that stand for all; see ChoosePoints.
int ChooseFour(const PlanarPoint* points, int count, const Approach& approach, int* chosen) {
  // Each choice is a pass of arithmetic over all points, which compilers turn into vector
  // instructions, and a search through its results.
  std::array<double, kMaxPlanarPoints> x, y, value;
  for (int i = 0; i < count; ++i) {
    x[i] = points[i].x;
    y[i] = points[i].y;
    value[i] = points[i].phi;
  }
  for (int i = 0; i < count; ++i) value[i] += approach.At(x[i], y[i]);
  int first = 0;
  for (int i = 1; i < count; ++i) {
    if (value[i] < value[first] - kDepthTie) first = i;
  }
  const PlanarPoint& p0 = points[first];
  for (int i = 0; i < count; ++i) {
    value[i] = (x[i] - p0.x) * (x[i] - p0.x) + (y[i] - p0.y) * (y[i] - p0.y);
  }
  const int second = FindLargest(value.data(), count, 0.0);
  chosen[0] = first;
  if (second < 0) return 1;
  chosen[1] = second;
  const PlanarPoint& p1 = points[second];

  const SignedArea base(p0, p1);
  for (int i = 0; i < count; ++i) value[i] = std::abs(base.At(x[i], y[i]));
  const int third = FindLargest(value.data(), count, kMinArea);
  if (third < 0) return 2;
  chosen[2] = third;
  const PlanarPoint& p2 = points[third];

  const double sign = base.At(p2.x, p2.y) > 0.0 ? 1.0 : -1.0;
  const SignedArea side_1(p1, p2), side_2(p2, p0);
  for (int i = 0; i < count; ++i) {
    const double outside_0 = -sign * base.At(x[i], y[i]);
    const double outside_1 = -sign * side_1.At(x[i], y[i]);
    const double outside_2 = -sign * side_2.At(x[i], y[i]);
    value[i] = std::max(outside_0, std::max(outside_1, outside_2));
  }
  const int fourth = FindLargest(value.data(), count, kMinArea);
  if (fourth < 0) return 3;
  chosen[3] = fourth;
  return 4;
}

// Height of a point over the plane through three others, along the normal [m].
double CalcHeight(const PlanarPoint& p, const PlanarPoint& p0, const PlanarPoint& p1,
                  const PlanarPoint& p2) {
  const SignedArea base(p0, p1), side(p2, p0);
  const double along_1 = side.At(p.x, p.y) * (p1.phi - p0.phi);
  const double along_2 = base.At(p.x, p.y) * (p2.phi - p0.phi);
  return p.phi - p0.phi - (along_1 + along_2) / base.At(p2.x, p2.y);
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

int ChoosePoints(const PlanarPoint* points, int count, const Approach& approach,
                 std::span<const std::uint32_t> loaded,
                 std::array<int, Manifold::kMaxPoints>* chosen) {
  if (count <= kNumCorners) {
    for (int i = 0; i < count; ++i) (*chosen)[i] = i;
    return count;
  }
  const int num_corners = ChooseFour(points, count, approach, chosen->data());
  int size = num_corners;
  for (const std::uint32_t feature : loaded) {
    if (size == Manifold::kMaxPoints) break;
    const auto is_it = [&](int i) { return points[i].feature == feature; };
    if (std::any_of(chosen->data(), chosen->data() + size, is_it)) continue;
    int i = 0;
    while (i < count && !is_it(i)) ++i;
    if (i == count) continue;
    const bool in_plane = num_corners > 2 &&
                          std::abs(CalcHeight(points[i], points[(*chosen)[0]], points[(*chosen)[1]],
                                              points[(*chosen)[2]])) < kInPlane;
    if (!in_plane) (*chosen)[size++] = i;
  }
  return size;
}

}  // namespace pregrasp
