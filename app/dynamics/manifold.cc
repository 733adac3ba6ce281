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
// Points this near to a line through two others [m] add nothing to them.
constexpr double kOnLine = 1e-7;

// A linear function of the tangent plane: twice the signed area of the triangle that a point makes
// with two others.
struct SignedArea {
  double x0, y0, dx, dy;

  SignedArea(const FacePoints& points, int from, int to)
      : x0(points.x[from]),
        y0(points.y[from]),
        dx(points.x[to] - points.x[from]),
        dy(points.y[to] - points.y[from]) {}
  double length() const { return std::hypot(dx, dy); }
  auto Of(const FacePoints& points) const {
    return dx * (points.ys() - y0) - dy * (points.xs() - x0);
  }
};

using Values = Eigen::Map<Eigen::ArrayXd>;

// The first of the largest values, of those that tie with the largest; -1 if none is above `least`.
int FindLargest(const Values& values, double least) {
  const double largest = values.maxCoeff();
  if (largest <= least) return -1;
  const double limit = largest * (1.0 - kSizeTie);
  int i = 0;
  while (values[i] < limit) ++i;
  return i;
}

// Those of more than four points that stand for all; see AddFacePoints.
int ChooseFour(const FacePoints& points, const Approach& approach, int* chosen) {
  std::array<double, FacePoints::kMaxSize> memory;
  Values values(memory.data(), points.size);
  values = approach.GapsAfter(points);
  const double deepest = values.minCoeff();
  int first = 0;
  while (values[first] > deepest + kDepthTie) ++first;
  chosen[0] = first;

  values = (points.xs() - points.x[first]).square() + (points.ys() - points.y[first]).square();
  const int second = FindLargest(values, kOnLine * kOnLine);
  if (second < 0) return 1;
  chosen[1] = second;

  const SignedArea base(points, first, second);
  const double min_area = kOnLine * base.length();
  values = base.Of(points).abs();
  const int third = FindLargest(values, min_area);
  if (third < 0) return 2;
  chosen[2] = third;

  // Farthest outside any side of the triangle, whose corners may go round either way.
  const double x_third = points.x[third] - base.x0, y_third = points.y[third] - base.y0;
  const double outside = base.dx * y_third - base.dy * x_third > 0.0 ? -1.0 : 1.0;
  const SignedArea side_1(points, second, third), side_2(points, third, first);
  values =
      (outside * base.Of(points)).max(outside * side_1.Of(points)).max(outside * side_2.Of(points));
  const int fourth = FindLargest(values, min_area);
  if (fourth < 0) return 3;
  chosen[3] = fourth;
  return 4;
}

// The plane through the gaps at three places.
struct GapPlane {
  double x0, y0, phi0, per_x, per_y;

  GapPlane(const FacePoints& points, int i0, int i1, int i2)
      : x0(points.x[i0]), y0(points.y[i0]), phi0(points.phi[i0]) {
    const double dx_1 = points.x[i1] - x0, dy_1 = points.y[i1] - y0;
    const double dx_2 = points.x[i2] - x0, dy_2 = points.y[i2] - y0;
    const double d_1 = points.phi[i1] - phi0, d_2 = points.phi[i2] - phi0;
    const double inv_area = 1.0 / (dx_1 * dy_2 - dx_2 * dy_1);
    per_x = (d_1 * dy_2 - d_2 * dy_1) * inv_area;
    per_y = (dx_1 * d_2 - dx_2 * d_1) * inv_area;
  }
  bool Holds(const FacePoints& points, int i) const {
    return std::abs(points.phi[i] - phi0 - per_x * (points.x[i] - x0) -
                    per_y * (points.y[i] - y0)) < kInPlane;
  }
  bool HoldsAll(const FacePoints& points) const {
    return (points.phis() - phi0 - per_x * (points.xs() - x0) - per_y * (points.ys() - y0))
               .abs()
               .maxCoeff() < kInPlane;
  }
};

// Chooses among more than four points; see AddFacePoints. Returns how many; their indices are in
// `chosen`.
int ChoosePoints(const FacePoints& points, const Approach& approach, Manifold* manifold,
                 std::array<int, Manifold::kMaxPoints>* chosen) {
  int size = ChooseFour(points, approach, chosen->data());
  if (size < 3) return size;
  const GapPlane plane(points, (*chosen)[0], (*chosen)[1], (*chosen)[2]);
  manifold->crowded = !plane.HoldsAll(points);
  if (!manifold->crowded) return size;
  for (const WorldState::CachedImpulse& loaded : manifold->loaded) {
    if (size == Manifold::kMaxPoints) break;
    const std::uint64_t key = loaded.key - manifold->key;
    const auto has_key = [&](int i) { return points.keys[i] == key; };
    if (std::any_of(chosen->data(), chosen->data() + size, has_key)) continue;
    int i = 0;
    while (i < points.size && !has_key(i)) ++i;
    if (i < points.size && !plane.Holds(points, i)) (*chosen)[size++] = i;
  }
  return size;
}

}  // namespace

Approach::Approach(const PlacedConvex& a, const PlacedConvex& b, const Vector3& nhat_W,
                   const ContactPlane& plane)
    : Approach(b.shift_W + b.turn_W.cross(plane.p_WO - b.p_WP) - a.shift_W -
                   a.turn_W.cross(plane.p_WO - a.p_WP),
               b.turn_W - a.turn_W, nhat_W, plane) {}

Approach::Approach(const Vector3& shift_W, const Vector3& turn_W, const Vector3& nhat_W,
                   const ContactPlane& plane)
    : at_origin(nhat_W.dot(shift_W)),
      per_x(nhat_W.dot(turn_W.cross(plane.x_W))),
      per_y(nhat_W.dot(turn_W.cross(plane.y_W))) {}

void AddFacePoints(const FacePoints& points, const ContactPlane& plane, const Approach& approach,
                   Manifold* manifold) {
  const auto add = [&](int i) {
    manifold->Add(plane.At(points.x[i], points.y[i], points.phi[i]), points.phi[i], points.keys[i]);
  };
  if (points.size <= kNumCorners) {
    for (int i = 0; i < points.size; ++i) add(i);
    return;
  }
  std::array<int, Manifold::kMaxPoints> chosen;
  const int num_chosen = ChoosePoints(points, approach, manifold, &chosen);
  for (int k = 0; k < num_chosen; ++k) add(chosen[k]);
  if (num_chosen == points.size || manifold->store == nullptr) return;
  manifold->plane = plane;
  manifold->face = &points;
  manifold->store->Keep();
}

}  // namespace pregrasp
