#pragma once

#include "app/dynamics/contact_rows.h"
#include "app/dynamics/motion.h"
#include "app/dynamics/world_state.h"
#include "app/scene/scene.h"

namespace pregrasp {

/// The law of one finger, and what follows from it for a step of `dt`.
struct FingertipLaw {
  double stiffness = 0.0;  ///< k [N/m]
  double damping = 0.0;    ///< b [N s/m]
  double friction = 0.0;
  double dt = 0.0;  ///< h [s]
  double inv_dt = 0.0;
  double max_impulse = 0.0;  ///< [N s]
  double gain = 0.0;         ///< k / (h k + b): velocity per stretch of the spring [1/s]
  double gamma = 0.0;        ///< compliance 1 / (h (h k + b)) [m/s per N s]
  double inv_gamma = 0.0;

  FingertipLaw() = default;
  /// @param tip  a finger that is on.
  FingertipLaw(const FingertipConfig& config, const FingertipState& tip, double dt);
};

/// A finger's contact with the object: rows along the inward normal and two tangents, with the
/// compliance of spring and damper on all three (see app/dynamics/README.md).
struct FingerRows {
  int finger = 0;
  FingertipLaw law;
  Matrix3 axes_W;         ///< columns inward normal, tangent 1, tangent 2
  Matrix3 A;              ///< columns the rows' angular parts, in the object's w_P
  double inv_mass = 0.0;  ///< of the object
  Matrix3 K;              ///< J M^-1 J^T + gamma
  Matrix3 inv_K;
  Vector3 r_W;                       ///< contact point from the centre of mass
  Vector3 target;                    ///< velocity at which the spring would bring the point home
  double gap_velocity = 0.0;         ///< gap / h: taken off the normal target
  Vector3 lambda = Vector3::Zero();  ///< impulse on the object: inward, tangent 1, tangent 2
  bool sliding = false;              ///< held by the friction cone in the last sweep
  bool capped = false;               ///< held by the force cap in the last sweep

  /// Sets all of it for a step of the object from `state`, whose pose `object` holds too.
  void Set(const FingertipLaw& finger_law, int index, const FingertipState& tip,
           const BodyState& state, const BodyKernel& kernel, const BodyMotion& object);

  /// Velocity of the object's point along the rows.
  Vector3 CalcVelocity(const BodyVelocity& y) const {
    return axes_W.transpose() * y.v_W + A.transpose() * y.w_P;
  }

  /// Adds what an impulse along the rows does to the object's velocity.
  void AddImpulse(const Vector3& d, BodyVelocity* y) const {
    y->v_W += axes_W * (inv_mass * d);
    y->w_P += A * d;
  }

  /// One Gauss-Seidel update; returns the largest change of an impulse [N s].
  double Sweep(BodyVelocity* y);

 private:
  void SetEffectiveMass(double gamma);
};

}  // namespace pregrasp
