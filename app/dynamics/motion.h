#pragma once

#include <vector>

#include "app/core/math.h"
#include "app/dynamics/indices.h"

namespace pregrasp {

/// The constants of one movable body, as the inner loop uses them. P is the body's principal frame:
/// its origin is the centre of mass, its axes are the principal axes of inertia.
struct BodyKernel {
  BodyIndex body;
  double mass = 0.0;  ///< [kg]
  Vector3 p_BoBcm = Vector3::Zero();
  Matrix3 R_BP = Matrix3::Identity();
  bool is_aligned = true;         ///< R_BP is the identity
  Vector3 I_P = Vector3::Zero();  ///< principal moments [kg m^2]
  double inv_mass = 0.0;
  Vector3 inv_sqrt_I_P = Vector3::Zero();
  double reach = 0.0;  ///< largest distance of a point of the shape from the centre of mass [m]

  Matrix3 CalcR_WP(const Matrix3& R_WB) const { return is_aligned ? R_WB : Matrix3(R_WB * R_BP); }
};

/// Builds the derived constants. Axes that are principal already are kept exactly.
BodyKernel MakeBodyKernel(BodyIndex body, double mass, const Vector3& p_BoBcm,
                          const Matrix3& I_BBcm, double reach);

/// Where a movable body is within one step and how it moves before the contacts act.
struct BodyMotion {
  Matrix3 R_WB = Matrix3::Identity();
  Matrix3 R_WP = Matrix3::Identity();
  Vector3 p_WB = Vector3::Zero();
  Vector3 p_WBcm = Vector3::Zero();
  Vector3 w_WB = Vector3::Zero();    ///< predicted: gravity applied
  Vector3 v_WBcm = Vector3::Zero();  ///< predicted, of the centre of mass
};

/// How far a step takes a movable body, to first order.
struct BodyStep {
  Vector3 shift_W = Vector3::Zero();  ///< of its centre of mass [m]
  Vector3 turn_W = Vector3::Zero();   ///< [rad]
};

/// What the contacts of one step did to one movable body: impulses about its centre of mass,
/// expressed in W.
struct BodyImpulse {
  Vector3 linear = Vector3::Zero();   ///< [N s]
  Vector3 angular = Vector3::Zero();  ///< [N m s]
  /// Pseudo-impulses of the position correction: they move the body in this step and leave no
  /// velocity behind.
  Vector3 linear_correction = Vector3::Zero();
  Vector3 angular_correction = Vector3::Zero();
};

}  // namespace pregrasp
