#include <algorithm>
#include <array>
#include <cmath>

#include "app/dynamics/collide.h"
#include "app/dynamics/rim.h"
#include "app/dynamics/support.h"

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
  std::uint32_t flag = 0;  // set in every feature

  // Adds point p_A of q's surface if it is near enough.
  void Add(const Vector3& p_A, std::uint32_t feature, Manifold* manifold) const {
    const double phi = s * p_A[i] - a.convex->half[i];
    if (phi > margin) return;
    Vector3 p_AC = p_A;
    p_AC[i] -= 0.5 * s * phi;
    manifold->Add(a.p_WP + a.ToWorld(p_AC), phi, feature | flag);
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

// A cylinder against the plane: its lower end's rim, or the line of its side nearest to the plane.
void AddCylinderPoints(const FacePlane& plane, Manifold* manifold) {
  constexpr double kEndCosine = 0.5;
  const Convex& q = *plane.q.convex;
  const Vector3 axis = plane.R_AQ.col(2);
  const Vector3 nhat = plane.s * Vector3::Unit(plane.i);
  const double c = axis.dot(nhat);
  if (std::abs(c) < kEndCosine) {
    // Towards the plane, at right angles to the axis.
    const Vector3 radial = (c * axis - nhat).normalized() * q.radius;
    plane.Add(plane.p_AQ - q.half_height * axis + radial, 8, manifold);
    plane.Add(plane.p_AQ + q.half_height * axis + radial, 9, manifold);
    return;
  }
  const Vector3 turn = plane.a.FromWorld(Vector3(plane.q.turn_W - plane.a.turn_W));
  const Vector3 nhat_next = nhat - turn.cross(nhat);  // as the turning cylinder sees it
  const auto down = [&plane](const Vector3& n) {
    return Vector2(-n.dot(plane.R_AQ.col(0)), -n.dot(plane.R_AQ.col(1)));
  };
  const RimPoints rim = ChooseRimPoints(q.radius, down(nhat), down(nhat_next));
  const Vector3 center = plane.p_AQ - std::copysign(q.half_height, c) * axis;
  for (int k = 0; k < 4; ++k) {
    const Vector2 r = q.radius * rim.directions[k];
    plane.Add(center + r.x() * plane.R_AQ.col(0) + r.y() * plane.R_AQ.col(1), rim.ids[k], manifold);
  }
  manifold->round = manifold->size == 4;
}

void AddCapsulePoints(const FacePlane& plane, Manifold* manifold) {
  const Convex& q = *plane.q.convex;
  const Vector3 axis = q.half_height * plane.R_AQ.col(2);
  Vector3 p = plane.p_AQ;
  p[plane.i] -= plane.s * q.radius;
  plane.Add(p - axis, 0, manifold);
  if (q.half_height > 0.0) plane.Add(p + axis, 1, manifold);
}

// All vertices near the plane, seen from q's origin.
void AddPolytopeVertices(const FacePlane& plane, Manifold* manifold) {
  constexpr int kBlock = 64;
  const Polytope& polytope = *plane.q.convex->polytope;
  const std::vector<Vector3>& vertices = polytope.vertices;
  const int ix = (plane.i + 1) % 3, iy = (plane.i + 2) % 3;
  const Vector3 n = plane.s * plane.R_AQ.row(plane.i);
  const Vector3 x = plane.R_AQ.row(ix), y = plane.R_AQ.row(iy);
  const double base = plane.s * plane.p_AQ[plane.i] - plane.a.convex->half[plane.i];
  const double limit = plane.margin - base;
  FacePoints own;
  FacePoints& points = manifold->NextFace(&own);
  const auto add = [&](int i, double height) {
    points.Add(x.dot(vertices[i]), y.dot(vertices[i]), base + height,
               static_cast<std::uint32_t>(i) | plane.flag);
  };
  int lowest = -1;
  double lowest_height = limit;
  std::array<double, kBlock> memory;
  const int num_vertices = static_cast<int>(vertices.size());
  for (int first = 0; first < num_vertices; first += kBlock) {
    const int block = std::min(kBlock, num_vertices - first);
    const auto numbers = [&](const std::vector<double>& all) {
      return Eigen::Map<const Eigen::ArrayXd>(all.data() + first, block);
    };
    Eigen::Map<Eigen::ArrayXd> heights(memory.data(), block);
    heights =
        n.x() * numbers(polytope.x) + n.y() * numbers(polytope.y) + n.z() * numbers(polytope.z);
    if (heights.minCoeff() > limit) continue;
    for (int i = 0; i < block; ++i) {
      if (heights[i] > limit) continue;
      if (lowest < 0 || heights[i] < lowest_height) {
        lowest_height = heights[i];
        lowest = first + i;
      }
      if (points.size < FacePoints::kMaxSize) add(first + i, heights[i]);
    }
  }
  if (lowest < 0) return;
  if (points.size == FacePoints::kMaxSize) {  // a crowd cannot push it out
    --points.size;
    add(lowest, lowest_height);
  }
  ContactPlane contact{plane.p_AQ, plane.a.R_WP.col(ix), plane.a.R_WP.col(iy),
                       plane.s * plane.a.R_WP.col(plane.i)};
  contact.p_WO[plane.i] = plane.s * plane.a.convex->half[plane.i];
  contact.p_WO = plane.a.p_WP + plane.a.ToWorld(contact.p_WO);
  AddFacePoints(points, contact, Approach(plane.a, plane.q, contact.nhat_W, contact), manifold);
}

}  // namespace

FaceOutcome CollideWithBoxFace(const PlacedConvex& a, const PlacedConvex& q, double margin,
                               std::uint32_t flag, Manifold* manifold) {
  FacePlane plane{a, q, a.FromWorld(q.R_WP), a.FromWorld(Vector3(q.p_WP - a.p_WP))};
  plane.margin = margin;
  plane.flag = flag;
  const Vector3& half = a.convex->half;
  int num_inside = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double extent = plane.R_AQ.row(axis).cwiseAbs().dot(q.convex->half);
    const double center = std::abs(plane.p_AQ[axis]);
    if (center - extent - half[axis] > margin) return FaceOutcome::kApart;
    if (center + extent <= half[axis] + kMinOverlap) {
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
    case ConvexKind::kCylinder:
      AddCylinderPoints(plane, manifold);
      break;
    case ConvexKind::kCapsule:
      AddCapsulePoints(plane, manifold);
      break;
    case ConvexKind::kPolytope:
      AddPolytopeVertices(plane, manifold);
      break;
  }
  return manifold->size > 0 ? FaceOutcome::kTouching : FaceOutcome::kApart;
}

}  // namespace pregrasp::internal
