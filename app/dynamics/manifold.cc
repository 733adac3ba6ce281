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
    limit = values[i] * (1.0 + kSizeTie);
    largest = i;
  }
  return largest;
}

// Those of more than four points that stand for all; see AddFacePoints.
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
  const int second = FindLargest(value.data(), count, kOnLine * kOnLine);
  chosen[0] = first;
  if (second < 0) return 1;
  chosen[1] = second;
  const PlanarPoint& p1 = points[second];

  const SignedArea base(p0, p1);
  for (int i = 0; i < count; ++i) value[i] = std::abs(base.At(x[i], y[i]));
  const double min_area = kOnLine * std::hypot(base.dx, base.dy);
  const int third = FindLargest(value.data(), count, min_area);
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
  const int fourth = FindLargest(value.data(), count, min_area);
  if (fourth < 0) return 3;
  chosen[3] = fourth;
  return 4;
}

// The plane through the gaps at three places.
struct GapPlane {
  double x0, y0, phi0, per_x, per_y;

  GapPlane(const PlanarPoint& p0, const PlanarPoint& p1, const PlanarPoint& p2)
      : x0(p0.x), y0(p0.y), phi0(p0.phi) {
    const double dx_1 = p1.x - x0, dy_1 = p1.y - y0, dx_2 = p2.x - x0, dy_2 = p2.y - y0;
    const double d_1 = p1.phi - phi0, d_2 = p2.phi - phi0;
    const double inv_area = 1.0 / (dx_1 * dy_2 - dx_2 * dy_1);
    per_x = (d_1 * dy_2 - d_2 * dy_1) * inv_area;
    per_y = (dx_1 * d_2 - dx_2 * d_1) * inv_area;
  }
  bool Holds(const PlanarPoint& p) const {
    return std::abs(p.phi - phi0 - per_x * (p.x - x0) - per_y * (p.y - y0)) < kInPlane;
  }
};

// Chooses among more than four points; see AddFacePoints. Returns how many; their indices are in
// `chosen`.
int ChoosePoints(const PlanarPoint* points, int count, const Approach& approach, Manifold* manifold,
                 std::array<int, Manifold::kMaxPoints>* chosen) {
  int size = ChooseFour(points, count, approach, chosen->data());
  if (size < 3) return size;
  const GapPlane plane(points[(*chosen)[0]], points[(*chosen)[1]], points[(*chosen)[2]]);
  manifold->crowded = !std::all_of(points, points + count,
                                   [&plane](const PlanarPoint& p) { return plane.Holds(p); });
  if (!manifold->crowded) return size;
  for (const WorldState::CachedImpulse& loaded : manifold->loaded) {
    if (size == Manifold::kMaxPoints) break;
    const auto is_it = [&](int i) { return manifold->key + points[i].key == loaded.key; };
    if (std::any_of(chosen->data(), chosen->data() + size, is_it)) continue;
    int i = 0;
    while (i < count && !is_it(i)) ++i;
    if (i < count && !plane.Holds(points[i])) (*chosen)[size++] = i;
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

void AddFacePoints(const PlanarPoint* points, int count, const ContactPlane& plane,
                   const Approach& approach, Manifold* manifold) {
  const auto add = [&](const PlanarPoint& point) {
    manifold->Add(plane.At(point.x, point.y, point.phi), point.phi, point.key);
  };
  if (count <= kNumCorners) {
    std::for_each(points, points + count, add);
    return;
  }
  std::array<int, Manifold::kMaxPoints> chosen;
  const int num_chosen = ChoosePoints(points, count, approach, manifold, &chosen);
  for (int k = 0; k < num_chosen; ++k) add(points[chosen[k]]);
  if (num_chosen == count || manifold->face_points == nullptr) return;
  manifold->plane = plane;
  manifold->first_face_point = static_cast<int>(manifold->face_points->size());
  manifold->num_face_points = count;
  for (int i = 0; i < count; ++i) {
    const PlanarPoint& point = points[i];
    manifold->face_points->push_back({point.x, point.y, point.phi, manifold->key + point.key});
  }
}

}  // namespace pregrasp
