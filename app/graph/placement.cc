#include "app/graph/placement.h"

#include <cmath>

namespace pregrasp {

bool HasRoom(double radius, const Placement::Contact& contact, const SignedDistance& shape) {
  const Vector3 p_OTip = contact.p_OC + radius * contact.nhat_O;
  return shape.Calc(p_OTip) >= radius - kOwnOverlapAllowed;
}

Placement::Contact ContactOnTriangle(const TriangleMesh& mesh, int t, const Vector3& w,
                                     const SignedDistance& shape) {
  Vector3 p_O = Vector3::Zero();
  for (int i = 0; i < 3; ++i) p_O += w[i] * mesh.V.row(mesh.F(t, i)).transpose();
  Placement::Contact contact;
  contact.on = true;
  const FacePoint face = shape.ProjectToFace(p_O);
  contact.p_OC = face.p_B;
  contact.nhat_O = face.nhat_B;
  return contact;
}

Vector3 BarycentricFromSquare(double u, double v) {
  const double root = std::sqrt(u);
  return {1.0 - root, root * (1.0 - v), root * v};
}

}  // namespace pregrasp
