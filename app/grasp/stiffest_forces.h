#pragma once

#include <span>

#include "app/core/math.h"
#include "app/grasp/wrench.h"

namespace pregrasp {

/// Admissible forces that balance the weight and hold the object more stiffly than `start`, which
/// are such forces. The stiffness is linear in the forces and its least eigenvalue concave, so this
/// is a concave maximisation over a convex set: projected supergradient ascent (Dykstra's
/// projection onto cones and balance) in a fixed number of steps; the best of all is taken, and
/// `start` if none is better. Balance holds to rounding, the bounds are kept. About 2 ms.
/// @param contacts     from the centre of mass.
/// @param wrench       friction, weight and bounds of the forces.
/// @param k            stiffness of the springs [N/m].
/// @param turn_length  [m] a radian, as in FindLeastStiffness.
MatrixX3 FindStiffestForces(std::span<const WrenchContact> contacts, const WrenchConfig& wrench,
                            double k, double turn_length, const MatrixX3& start);

}  // namespace pregrasp
