#include "app/dynamics/fingertip.h"

#include <algorithm>
#include <cmath>

namespace pregrasp {
namespace {

// A slipping point that ends farther above the surface than this share of its slip has passed an
// edge; nearer, it has followed a curved face.
constexpr double kEdgeShare = 0.25;

double CalcCompliance(const FingertipLaw& law, double dt) {
  return 1.0 / (dt * (dt * law.stiffness + law.damping));
}

// Cuts a starting impulse to what the law allows: inward, inside the cone, under the cap.
Vector3 ProjectImpulse(const Vector3& impulse, double friction, double max_impulse) {
  Vector3 lambda = impulse;
  lambda[0] = std::max(0.0, lambda[0]);
  const double limit = friction * lambda[0], tangential = lambda.tail<2>().norm();
  if (tangential > limit) lambda.tail<2>() *= limit / tangential;
  const double norm = lambda.norm();
  if (norm > max_impulse) lambda *= max_impulse / norm;
  return lambda;
}

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

FingertipLaw::FingertipLaw(const FingertipConfig& config, double object_mass)
    : stiffness(config.stiffness),
      damping(config.damping * std::sqrt(config.stiffness * object_mass)),
      friction(config.friction),
      max_force(config.max_force) {}

void PlaceFinger(const SignedDistance& surface, const RigidTransform& X_WO, const Vector3& p_OC,
                 FingertipState* finger) {
  *finger = {};
  finger->on = true;
  finger->p_OC = surface.Project(p_OC, &finger->nhat_O);
  finger->p_WF = finger->p_WTarget = X_WO * finger->p_OC;
}

FingerRows MakeFingerRows(const FingertipLaw& law, const FingertipState& finger, int index,
                          const BodyState& state, const BodyMotion& object, double dt) {
  FingerRows rows;
  rows.finger = index;
  rows.R_WC = FrameFromNormal(object.R_WB * finger.nhat_O);
  const Vector3 p_WC = object.p_WB + object.R_WB * finger.p_OC;
  rows.r_W = p_WC - object.p_WBcm;
  const Vector3 nhat_W = rows.R_WC.col(2);
  const Vector3 p_WF = finger.touching ? p_WC : finger.p_WF;
  rows.gap_velocity = std::max(0.0, nhat_W.dot(p_WF - p_WC)) / dt;
  rows.gamma = CalcCompliance(law, dt);
  const auto along_rows = [&rows](const Vector3& v_W) {
    const Vector3 v_C = rows.R_WC.transpose() * v_W;
    return Vector3(-v_C.z(), v_C.x(), v_C.y());
  };
  rows.target =
      along_rows((finger.p_WTarget - p_WF) * (law.stiffness / (dt * law.stiffness + law.damping)));
  rows.friction = law.friction;
  rows.max_impulse = dt * law.max_force;
  if (finger.touching) {
    // The spring's impulse if the object's point kept its velocity: nearer than the last impulse
    // while the target moves.
    const Vector3 v_WC = state.v_WB + state.w_WB.cross(object.R_WB * finger.p_OC);
    rows.lambda = ProjectImpulse((rows.target - along_rows(v_WC)) / rows.gamma, rows.friction,
                                 rows.max_impulse);
  }
  return rows;
}

void AdvanceFinger(const FingertipLaw& law, const SignedDistance& surface, const FingerRows& rows,
                   const Vector3& v_object, const RigidTransform& X_WO, double dt,
                   FingertipState* finger) {
  finger->f_W = rows.ToWorld(rows.lambda) / dt;
  finger->slipping = false;
  if (rows.lambda[0] <= 0.0) {
    // Free: k (p_target - p) = b v at the end of the step.
    const Vector3 v_WF = rows.ToWorld(rows.target);
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
    lambda *= (rows.target[0] - rows.gap_velocity - v_object[0]) / (rows.gamma * lambda[0]);
  }
  Vector3 slip = dt * (rows.target - rows.gamma * lambda - v_object);
  slip[0] = 0.0;
  SlipOverSurface(surface, X_WO, rows.ToWorld(slip), finger);
}

}  // namespace pregrasp
