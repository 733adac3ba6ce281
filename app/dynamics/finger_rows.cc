#include "app/dynamics/finger_rows.h"

#include <algorithm>
#include <cmath>

#include "app/core/check.h"

namespace pregrasp {
namespace {

// Cuts an impulse to the friction cone; tells whether it was outside.
bool CutToCone(double friction, Vector3* lambda) {
  const double limit = friction * (*lambda)[0], norm2 = lambda->tail<2>().squaredNorm();
  if (norm2 <= limit * limit) return false;
  lambda->tail<2>() *= limit / std::sqrt(norm2);
  return true;
}

// Cuts an impulse to the ball of the force cap; tells whether it was outside.
bool CutToCap(double max_impulse, Vector3* lambda) {
  const double norm2 = lambda->squaredNorm();
  if (norm2 <= max_impulse * max_impulse) return false;
  *lambda *= max_impulse / std::sqrt(norm2);
  return true;
}

}  // namespace

FingertipLaw::FingertipLaw(const FingertipConfig& config, const FingertipState& tip, double dt_in)
    : stiffness(tip.stiffness),
      damping(tip.damping),
      friction(config.friction),
      dt(dt_in),
      inv_dt(1.0 / dt),
      max_impulse(dt * config.max_force),
      gain(stiffness / (dt * stiffness + damping)),
      gamma(1.0 / (dt * (dt * stiffness + damping))),
      inv_gamma(1.0 / gamma) {
  PREGRASP_CHECK(stiffness > 0.0 && damping >= 0.0, stiffness, damping);
}

void FingerRows::Set(const FingertipLaw& finger_law, int index, const FingertipState& tip,
                     const BodyState& state, const BodyKernel& kernel, const BodyMotion& object) {
  finger = index;
  law = finger_law;
  sliding = capped = false;
  inv_mass = kernel.inv_mass;
  const Matrix3 R_WC = FrameFromNormal(object.R_WB * tip.nhat_O);
  axes_W.col(0) = -R_WC.col(2);
  axes_W.col(1) = R_WC.col(0);
  axes_W.col(2) = R_WC.col(1);
  const Vector3 p_BC_W = object.R_WB * tip.p_OC;
  const Vector3 p_WC = object.p_WB + p_BC_W;
  r_W = p_WC - object.p_WBcm;
  for (int i = 0; i < 3; ++i) {
    const Vector3 axis = axes_W.col(i);
    A.col(i) = kernel.inv_sqrt_I_P.cwiseProduct(object.R_WP.transpose() * r_W.cross(axis));
  }
  SetEffectiveMass(law.gamma);

  lambda.setZero();
  gap_velocity = 0.0;
  if (tip.touching) {
    target = axes_W.transpose() * (law.gain * (tip.p_WTarget - p_WC));
    // The spring's impulse if the object's point kept its velocity: nearer than the last impulse
    // while the target moves.
    const Vector3 v_WC = state.v_WB + state.w_WB.cross(p_BC_W);
    lambda = law.inv_gamma * (target - axes_W.transpose() * v_WC);
    lambda[0] = std::max(0.0, lambda[0]);
    CutToCone(law.friction, &lambda);
    CutToCap(law.max_impulse, &lambda);
  } else {
    target = axes_W.transpose() * (law.gain * (tip.p_WTarget - tip.p_WF));
    gap_velocity = law.inv_dt * std::max(0.0, axes_W.col(0).dot(p_WC - tip.p_WF));
  }
}

void FingerRows::SetEffectiveMass(double gamma) {
  const double own = inv_mass + gamma;  // the rows' linear parts are orthogonal
  const double k_00 = own + A.col(0).squaredNorm(), k_11 = own + A.col(1).squaredNorm(),
               k_22 = own + A.col(2).squaredNorm(), k_01 = A.col(0).dot(A.col(1)),
               k_02 = A.col(0).dot(A.col(2)), k_12 = A.col(1).dot(A.col(2));
  K << k_00, k_01, k_02, k_01, k_11, k_12, k_02, k_12, k_22;
  const double c_00 = k_11 * k_22 - k_12 * k_12, c_01 = k_02 * k_12 - k_01 * k_22,
               c_02 = k_01 * k_12 - k_02 * k_11, c_11 = k_00 * k_22 - k_02 * k_02,
               c_12 = k_01 * k_02 - k_00 * k_12, c_22 = k_00 * k_11 - k_01 * k_01;
  inv_K << c_00, c_01, c_02, c_01, c_11, c_12, c_02, c_12, c_22;
  inv_K *= 1.0 / (k_00 * c_00 + k_01 * c_01 + k_02 * c_02);
}

// The spring's impulse is cut to the friction cone, then to the ball of the force cap (scaling
// keeps a vector in the cone, so the result is in both). Each step is scaled so that its fixed
// point is the exact law: one scale for both tangents where the cone holds, one for all three rows
// where the cap does.
double FingerRows::Sweep(BodyVelocity* y) {
  Vector3 v = CalcVelocity(*y) + law.gamma * lambda - target;
  v[0] += gap_velocity;
  Vector3 next = lambda - inv_K * v;
  sliding = capped = false;
  const double limit = law.friction * next[0];
  const double max2 = law.max_impulse * law.max_impulse;
  if (!(next[0] >= 0.0 && next.tail<2>().squaredNorm() <= limit * limit &&
        next.squaredNorm() <= max2)) {
    next[0] = std::max(0.0, lambda[0] - v[0] / K(0, 0));
    const Vector2 v_t = v.tail<2>() + K.block<2, 1>(1, 0) * (next[0] - lambda[0]);
    next.tail<2>() = lambda.tail<2>() - v_t / LargerEigenvalue(K(1, 1), K(1, 2), K(2, 2));
    sliding = CutToCone(law.friction, &next);
    if (next.squaredNorm() > max2) {
      next = lambda - v / K.norm();  // which bounds the largest eigenvalue
      next[0] = std::max(0.0, next[0]);
      sliding = CutToCone(law.friction, &next);
      capped = CutToCap(law.max_impulse, &next);
    }
  }
  const Vector3 d = next - lambda;
  lambda = next;
  AddImpulse(d, y);
  return d.cwiseAbs().maxCoeff();
}

}  // namespace pregrasp
