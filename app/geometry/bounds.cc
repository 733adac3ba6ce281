#include "app/geometry/bounds.h"

#include "app/core/check.h"

namespace pregrasp {
namespace {

AlignedBox Around(const Vector3& centre, const Vector3& half) {
  return {Vector3(centre - half), Vector3(centre + half)};
}

struct BoundsOf {
  const RigidTransform& X_AB;

  AlignedBox operator()(const Box& box) const {
    return Around(X_AB.translation(), X_AB.linear().cwiseAbs() * (0.5 * box.size));
  }
  AlignedBox operator()(const Cylinder& cylinder) const {
    const Vector3 axis = X_AB.linear().col(2);
    // A disc of radius r with unit normal a reaches r sqrt(1 - a_i^2) along axis i.
    const Vector3 disc = (Vector3::Ones() - axis.cwiseAbs2()).cwiseMax(0.0).cwiseSqrt();
    return Around(X_AB.translation(),
                  0.5 * cylinder.height * axis.cwiseAbs() + cylinder.radius * disc);
  }
  AlignedBox operator()(const Capsule& capsule) const {
    const Vector3 axis = X_AB.linear().col(2);
    return Around(X_AB.translation(),
                  0.5 * capsule.height * axis.cwiseAbs() + Vector3::Constant(capsule.radius));
  }
  AlignedBox operator()(const Sphere& sphere) const {
    return Around(X_AB.translation(), Vector3::Constant(sphere.radius));
  }
  AlignedBox operator()(const Mesh& mesh) const { return OfPoints(mesh.mesh.V); }
  AlignedBox operator()(const Cloud& cloud) const { return OfPoints(cloud.mesh.V); }
  AlignedBox operator()(const Union& whole) const {
    AlignedBox bounds;
    for (const PlacedShape& part : whole.parts) {
      bounds.extend(CalcBounds(part.shape, X_AB * part.X_BP));
    }
    return bounds;
  }

  AlignedBox OfPoints(const MatrixX3& V) const {
    PREGRASP_CHECK(V.rows() > 0, "shape is not loaded");
    AlignedBox bounds;
    for (int i = 0; i < V.rows(); ++i) bounds.extend(X_AB * Vector3(V.row(i)));
    return bounds;
  }
};

}  // namespace

AlignedBox CalcBounds(const Shape& shape, const RigidTransform& X_AB) {
  return std::visit(BoundsOf{X_AB}, shape);
}

}  // namespace pregrasp
