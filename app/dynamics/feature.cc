#include "app/dynamics/feature.h"

#include <cmath>

namespace pregrasp {
namespace {

// A cylinder shows its end within this cosine of its axis, and its side beyond. Between the two
// only one point of the rim can be near, and both features hold it.
constexpr double kEndCosine = 0.5;

void SetSegment(const Vector3& from, const Vector3& to, Feature* feature) {
  feature->kind = Feature::Kind::kSegment;
  feature->size = 2;
  feature->points[0] = from;
  feature->points[1] = to;
  feature->ids[0] = 0;
  feature->ids[1] = 1;
}

void SetCylinderFeature(const PlacedConvex& placed, const Vector3& nhat_W, Feature* feature) {
  const Convex& convex = *placed.convex;
  const Vector3 axis = placed.R_WP.col(2);
  const double c = axis.dot(nhat_W);
  const Vector3 end = std::copysign(convex.half_height, c) * axis;
  if (std::abs(c) >= kEndCosine) {
    feature->kind = Feature::Kind::kDisc;
    feature->size = 1;
    feature->points[0] = placed.p_WP + end;
    feature->ids[0] = c > 0.0 ? 1 : 0;
    feature->nhat_W = c > 0.0 ? axis : Vector3(-axis);
    feature->u_W = convex.radius * placed.R_WP.col(0);
    feature->w_W = convex.radius * placed.R_WP.col(1);
    return;
  }
  const Vector3 radial = (nhat_W - c * axis).normalized() * convex.radius;
  SetSegment(placed.p_WP - convex.half_height * axis + radial,
             placed.p_WP + convex.half_height * axis + radial, feature);
}

void SetFaceFeature(const PlacedConvex& placed, int face_index, Feature* feature) {
  const Polytope& polytope = *placed.convex->polytope;
  const Polytope::Face& face = polytope.faces[face_index];
  feature->kind = Feature::Kind::kPolygon;
  feature->nhat_W = placed.R_WP * face.nhat;
  feature->size = face.count;
  for (int i = 0; i < face.count; ++i) {
    feature->points[i] = placed.p_WP + placed.R_WP * polytope.corner(face, i);
    feature->ids[i] = static_cast<std::uint32_t>(polytope.corners[face.first + i]);
  }
}

}  // namespace

void FindFeature(const PlacedConvex& placed, const Vector3& nhat_W, Feature* feature) {
  const Convex& convex = *placed.convex;
  switch (convex.kind) {
    case ConvexKind::kBox:
    case ConvexKind::kPolytope: {
      const Vector3 n = placed.R_WP.transpose() * nhat_W;
      const auto& faces = convex.polytope->faces;
      int best = 0;
      for (int i = 1; i < static_cast<int>(faces.size()); ++i) {
        if (faces[i].nhat.dot(n) > faces[best].nhat.dot(n)) best = i;
      }
      SetFaceFeature(placed, best, feature);
      break;
    }
    case ConvexKind::kCylinder:
      SetCylinderFeature(placed, nhat_W, feature);
      break;
    case ConvexKind::kCapsule: {
      const Vector3 axis = convex.half_height * placed.R_WP.col(2);
      const Vector3 p = placed.p_WP + convex.radius * nhat_W;
      SetSegment(p - axis, p + axis, feature);
      if (convex.half_height == 0.0) {
        feature->kind = Feature::Kind::kPoint;
        feature->size = 1;
      }
      break;
    }
  }
}

}  // namespace pregrasp
