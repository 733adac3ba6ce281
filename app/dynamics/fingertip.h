#pragma once

#include "app/dynamics/finger_rows.h"
#include "app/dynamics/motion.h"
#include "app/dynamics/world_state.h"
#include "app/geometry/signed_distance.h"

namespace pregrasp {

/// Puts the finger on the surface point nearest to p_OC, its target there, its force zero.
/// @param damping  [N s/m]
void PlaceFinger(const SignedDistance& surface, const RigidTransform& X_WO, const Vector3& p_OC,
                 double stiffness, double damping, FingertipState* finger);

/// Gives the finger another spring. One that touches gets the target that keeps its force as long
/// as the object moves as in `object`.
void ChangeSpring(const BodyState& object, double stiffness, double damping,
                  FingertipState* finger);

/// Moves the finger to the end of the step: with the object where it sticks, over the surface where
/// it slips, towards its target where it is free.
/// @param v_object  velocity of the object's point after the contacts: inward, tangent 1,
/// tangent 2.
/// @param X_WO      the object's pose after the step.
void AdvanceFinger(const SignedDistance& surface, const FingerRows& rows, const Vector3& v_object,
                   const RigidTransform& X_WO, FingertipState* finger);

}  // namespace pregrasp
