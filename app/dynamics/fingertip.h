#pragma once

#include "app/dynamics/contact_solver.h"
#include "app/dynamics/motion.h"
#include "app/dynamics/world.h"
#include "app/geometry/signed_distance.h"

namespace pregrasp {

/// The spring of one scene's fingers.
struct FingertipLaw {
  double stiffness = 0.0;  ///< k [N/m]
  double damping = 0.0;    ///< b [N s/m]
  double friction = 0.0;
  double max_force = 0.0;  ///< [N]

  FingertipLaw() = default;
  FingertipLaw(const FingertipConfig& config, double object_mass);
};

/// Puts the finger on the surface point nearest to p_OC, its target there, its force zero.
void PlaceFinger(const SignedDistance& surface, const RigidTransform& X_WO, const Vector3& p_OC,
                 FingertipState* finger);

/// The finger's contact rows for a step of the object from `state`, whose pose `object` holds too.
/// The solver adds the Jacobian.
FingerRows MakeFingerRows(const FingertipLaw& law, const FingertipState& finger, int index,
                          const BodyState& state, const BodyMotion& object, double dt);

/// Moves the finger to the end of the step: with the object where it sticks, over the surface where
/// it slips, towards its target where it is free.
/// @param v_object  velocity of the object's point after the contacts: inward, tangent 1,
/// tangent 2.
/// @param X_WO      the object's pose after the step.
void AdvanceFinger(const FingertipLaw& law, const SignedDistance& surface, const FingerRows& rows,
                   const Vector3& v_object, const RigidTransform& X_WO, double dt,
                   FingertipState* finger);

}  // namespace pregrasp
