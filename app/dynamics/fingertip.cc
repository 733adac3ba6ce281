#include "app/dynamics/fingertip.h"

#include <algorithm>
#include <cmath>

namespace pregrasp {
namespace {

// A slipping point that ends farther above the surface than this share of its slip has passed an
// edge; nearer, it has followed a curved face.
constexpr double kEdgeShare = 0.25;

// The finger leaves the surface, or stays away from it, at p_WF.
void SetFree(const SignedDistance& surface, const RigidTransform& X_WO, const Vector3& p_WF,
             FingertipState* finger) {
  finger->touching = false;
  const Vector3 p_OF = X_WO.inverse() * p_WF;
  const bool inside = surface.Calc(p_OF) < 0.0;
  finger->p_OC = surface.Project(p_OF, &finger->nhat_O);
  finger->p_WF = inside ? X_WO * finger->p_OC : p_WF;
}

void SlipOverSurface(const SignedDistance& surface, const RigidTransform& X_WO,
                     const Vector3& slip_W, FingertipState* finger) {
  const double slip = slip_W.norm();
  finger->slip += slip;
  const Vector3 p_OF = finger->p_OC + X_WO.linear().transpose() * slip_W;
  Vector3 nhat_O;
  const Vector3 p_OC = surface.Project(p_OF, &nhat_O);
  if (nhat_O.dot(p_OF - p_OC) > kEdgeShare * slip + 1e-9) {
    SetFree(surface, X_WO, X_WO * p_OF, finger);
    return;
  }
  finger->p_OC = p_OC;
  finger->nhat_O = nhat_O;
  finger->p_WF = X_WO * p_OC;
}

}  // namespace

void PlaceFinger(const SignedDistance& surface, const RigidTransform& X_WO, const Vector3& p_OC,
                 double stiffness, double damping, FingertipState* finger) {
  *finger = {};
  finger->on = true;
  finger->stiffness = stiffness;
  finger->damping = damping;
  finger->p_OC = surface.Project(p_OC, &finger->nhat_O);
  finger->p_WF = finger->p_WTarget = X_WO * finger->p_OC;
}

void ChangeSpring(const BodyState& object, double stiffness, double damping,
                  FingertipState* finger) {
  finger->stiffness = stiffness;
  finger->damping = damping;
  if (!finger->touching) return;
  const Vector3 v_WF = object.v_WB + object.w_WB.cross(finger->p_WF - object.p_WB);
  finger->p_WTarget = finger->p_WF + (finger->f_W + damping * v_WF) / stiffness;
}

void AdvanceFinger(const SignedDistance& surface, const FingerRows& rows, const Vector3& v_object,
                   const RigidTransform& X_WO, FingertipState* finger) {
  const FingertipLaw& law = rows.law;
  finger->f_W = rows.axes_W * (law.inv_dt * rows.lambda);
  finger->slipping = false;
  if (rows.lambda[0] <= 0.0) {
    // Free: k (p_target - p) = b v at the end of the step.
    const Vector3 v_WF = rows.axes_W * rows.target;
    SetFree(surface, X_WO, finger->p_WTarget - v_WF * (law.damping / law.stiffness), finger);
    return;
  }
  finger->touching = true;
  finger->slipping = rows.sliding;
  if (!rows.sliding) {
    finger->p_WF = X_WO * finger->p_OC;
    return;
  }
  // The impulse without the cap: what the spring's stretch alone would give at the cone's limit.
  Vector3 lambda = rows.lambda;
  if (rows.capped) {
    lambda *= (rows.target[0] - rows.gap_velocity - v_object[0]) / (law.gamma * lambda[0]);
  }
  Vector3 slip = law.dt * (rows.target - law.gamma * lambda - v_object);
  slip[0] = 0.0;
  SlipOverSurface(surface, X_WO, rows.axes_W * slip, finger);
}

}  // namespace pregrasp
