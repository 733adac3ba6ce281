#pragma once

#include <optional>
#include <span>

#include "app/core/math.h"
#include "app/grasp/wrench.h"

namespace pregrasp {

/// Second derivatives with respect to a small motion (d, theta) of the object: d of its centre of
/// mass [m], theta about it [rad].
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// The stiffness with which fingers hold an object at the forces they press with: the second
/// derivative of the energy of springs of stiffness `k` [N/m] (the same in all directions) that
/// act at the contacts, where the object is in balance. Springs alone give k J^T J; the forces add
/// what turning the object under them does, sum (f.p) 1 - sym(f p^T) for rotation: inner forces
/// that squeeze make it less stiff, and two contacts a half width a apart that are pressed with F
/// turn the object over above F = k a. While no contact slips, no approximation; see Murray, Li,
/// Sastry, "A Mathematical Introduction to Robotic Manipulation", chapter 5, and Cutkosky, Kao,
/// "Computing and controlling the compliance of a robotic hand" (1989) for grasp stiffness.
/// @param contacts  from the centre of mass.
/// @param forces    on the object [N], #contacts x 3, in the same frame.
Matrix6 CalcGraspStiffness(std::span<const WrenchContact> contacts, const MatrixX3& forces,
                           double k);

/// The direction in which a grasp is least stiff.
struct LeastStiffness {
  double value = 0.0;  ///< [N/m]: the least eigenvalue, rotation measured by `turn_length`
  Vector3 shift = Vector3::Zero();  ///< the unit direction's translation
  Vector3 turn = Vector3::Zero();   ///< and its rotation, turn_length times the angle
};

/// @param turn_length  [m]: how far a point that many metres off the centre of mass moves when the
///                     object turns by a radian; makes metres and radians comparable.
LeastStiffness FindLeastStiffness(const Matrix6& K, double turn_length);

struct GraspForcesConfig {
  /// Forces are chosen inside this share of the friction cone and of the cap where that is
  /// possible, else with half of the reserve, else without.
  double friction_reserve = 0.6;
  /// Rotation counts as translation by this length [m] a radian: 1 cm and 15 degrees, the bounds of
  /// a lift, are then the same.
  double turn_length = 0.01 / (kPi / 12.0);
  /// The least stiffness must exceed this share of a single spring's. A margin against rounding
  /// and a contact's place alone: what a grasp withstands, the simulation tells.
  double min_stiffness = 0.002;

  void Validate() const;
};

/// Forces for a grasp to hold with, in the frame of the contacts.
struct GraspForces {
  MatrixX3 forces;        ///< on the object [N], #contacts x 3; they balance the weight
  double reserve = 0.0;   ///< the share of cone and cap that they keep to
  double squeeze = 0.0;   ///< the smallest normal force [N]
  LeastStiffness least;   ///< at these forces
  bool is_stiff = false;  ///< `least` exceeds what the configuration asks for
};

/// The forces at which the grasp is stiffest (FindStiffestForces), inside the reserve. Nothing if
/// no forces balance the weight. Deterministic.
/// @param wrench  the scene's friction, weight, bounds of the forces, torque scale.
/// @param k       stiffness of the fingers' springs [N/m].
std::optional<GraspForces> ChooseGraspForces(std::span<const WrenchContact> contacts,
                                             const WrenchConfig& wrench, double k,
                                             const GraspForcesConfig& config);

}  // namespace pregrasp
