#include <cmath>

#include "app/dynamics/collide.h"

namespace pregrasp::internal {
namespace {

// A plane of box a, as axis `i` and side `s` of its frame, and q's pose in that frame.
struct FacePlane {
  const PlacedConvex& a;
  const PlacedConvex& q;
  Matrix3 R_AQ;
  Vector3 p_AQ;
  int i = 0;
  double s = 1.0;
  double margin = 0.0;

  // Adds point p_A of q's surface if it is near enough.
  void Add(const Vector3& p_A, std::uint32_t feature, Manifold* manifold) const {
    const double phi = s * p_A[i] - a.convex->half[i];
    if (phi > margin) return;
    Vector3 p_AC = p_A;
    p_AC[i] -= 0.5 * s * phi;
    manifold->Add(a.p_WP + a.R_WP * p_AC, phi, feature);
  }
};

// The four corners of the box face that looks at the plane most directly; the lowest corner is
// always among them.
void AddBoxCorners(const FacePlane& plane, Manifold* manifold) {
  const Vector3& half = plane.q.convex->half;
  const Vector3 row = plane.R_AQ.row(plane.i);
  int k = 0;
  row.cwiseAbs().maxCoeff(&k);
  const int u = (k + 1) % 3, v = (k + 2) % 3;
  const bool plus = plane.s * row[k] < 0.0;
  const Vector3 center = plane.p_AQ + plane.R_AQ.col(k) * (plus ? half[k] : -half[k]);
  const Vector3 du = plane.R_AQ.col(u) * half[u], dv = plane.R_AQ.col(v) * half[v];
  const std::uint32_t base = plus ? 1U << k : 0U;
  const std::uint32_t bit_u = 1U << u, bit_v = 1U << v;
  plane.Add(center + du + dv, base | bit_u | bit_v, manifold);
  plane.Add(center - du + dv, base | bit_v, manifold);
  plane.Add(center - du - dv, base, manifold);
  plane.Add(center + du - dv, base | bit_u, manifold);
}

}  // namespace

FaceOutcome CollideWithBoxFace(const PlacedConvex& a, const PlacedConvex& q, double margin,
                               Manifold* manifold) {
  FacePlane plane{a, q, a.R_WP.transpose() * q.R_WP, a.R_WP.transpose() * (q.p_WP - a.p_WP)};
  plane.margin = margin;
  const Vector3& half = a.convex->half;
  int num_inside = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double extent = plane.R_AQ.row(axis).cwiseAbs().dot(q.convex->half);
    const double center = std::abs(plane.p_AQ[axis]);
    if (center - extent - half[axis] > margin) return FaceOutcome::kApart;
    if (center + extent <= half[axis]) {
      ++num_inside;
    } else {
      plane.i = axis;
    }
  }
  if (num_inside != 2) return FaceOutcome::kNotApplicable;
  plane.s = plane.p_AQ[plane.i] < 0.0 ? -1.0 : 1.0;
  manifold->nhat_W = plane.s * a.R_WP.col(plane.i);
  switch (q.convex->kind) {
    case ConvexKind::kBox:
      AddBoxCorners(plane, manifold);
      break;
    default:
      return FaceOutcome::kNotApplicable;
  }
  return manifold->size > 0 ? FaceOutcome::kTouching : FaceOutcome::kApart;
}

}  // namespace pregrasp::internal
