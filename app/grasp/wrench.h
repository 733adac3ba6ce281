#pragma once

#include <span>
#include <vector>

#include "app/core/math.h"

namespace pregrasp {

/// A hard-finger point contact: it pushes along its normal and across it by friction, without
/// torsion.
struct WrenchContact {
  Vector3 p;  ///< [m], from the point about which torques are taken
  Vector3 n;  ///< into the object; any length above 0, used as a direction
};

struct WrenchConfig {
  double mu = 0.8;                   ///< friction coefficient of every contact, at least 0
  double mass = 0.0;                 ///< of the object [kg], its weight acting at the origin
  Vector3 gravity{0.0, 0.0, -9.81};  ///< [m/s^2]
  double f_min = 0.5;                ///< smallest normal force of every contact [N]
  double f_max = 12.0;               ///< largest normal force of every contact [N]
  double torque_scale = 1.0;  ///< torques are divided by this length [m]: the object's radius

  /// @throws InputError naming the field: not finite, mu, mass or f_min below 0, f_max below f_min
  /// or not above 0, torque_scale not above 0.
  void Validate() const;
};

/// The first condition that fails, in this order.
enum class WrenchStatus {
  kFeasible,
  kNoInternalForces,   ///< no admissible forces have zero net wrench
  kWeightNotBalanced,  ///< no admissible forces balance the object's weight
};

/// "feasible", "no internal forces", "weight not balanced".
const char* WrenchStatusName(WrenchStatus status);

struct WrenchResult {
  WrenchStatus status = WrenchStatus::kNoInternalForces;
  bool feasible() const { return status == WrenchStatus::kFeasible; }

  /// Ferrari-Canny epsilon, signed (see CalcMargin), and whether it is above 0: force closure.
  double margin = 0.0;
  bool closed = false;

  /// The admissible forces on the object [N] (#contacts x 3) that balance the weight with the least
  /// effort (smallest sum of squares: unique, and continuous in the contacts). They hold the object
  /// and no more; ask with a smaller mu for forces that keep a reserve against slipping. If not
  /// feasible: admissible forces on whose net wrench, in the condition that fails, the proof ended;
  /// others may come nearer to balance.
  MatrixX3 forces;
  /// The smallest normal component of `forces` [N].
  double min_normal = 0.0;
  /// The norm of the net wrench of `forces` [N, torque divided by torque_scale]. If not feasible,
  /// at least as much as is missing to balance.
  double residual = 0.0;
  /// If not feasible, the proof: a unit wrench-space direction (force, then scaled torque) along
  /// which the net wrench of all admissible forces, weight included, is above 0. Else zero.
  Eigen::Matrix<double, 6, 1> separating = Eigen::Matrix<double, 6, 1>::Zero();
};

/// Whether a grasp can hold: the design's "dynamically feasible". A force f at a contact is
/// admissible if it lies in the circular cone |f - (f n) n| <= mu f n and f_min <= f n <= f_max;
/// every contact must push. Feasible: admissible forces exist with zero net wrench (the paper's
/// condition, section "Preliminary"), and admissible forces exist that balance the weight.
///
/// The cones are exact, not polyhedral: all net wrenches of admissible forces form a compact convex
/// set with a support function in closed form, and the question is whether that set holds the
/// origin, which FindMinNormPoint answers, for each verdict with a proof: forces, or a separating
/// hyperplane. What misses balance by less than 1e-10 of the cap counts as balanced; where the
/// origin lies on the set's boundary to within rounding, 1e-7. No dependence on a choice of tangent
/// axes; a few microseconds.
/// @throws InputError for bad contacts (none, not finite, a zero normal) or a bad config.
WrenchStatus CalcWrenchStatus(std::span<const WrenchContact> contacts, const WrenchConfig& config);

/// The same; where the grasp is not feasible, *missing is the unit wrench (force, then torque over
/// torque_scale) on the object that admissible forces cannot give: the opposite of
/// WrenchResult::separating.
WrenchStatus CalcWrenchStatus(std::span<const WrenchContact> contacts, const WrenchConfig& config,
                              Eigen::Matrix<double, 6, 1>* missing);

/// The same verdict with forces, margin and proof; about a millisecond, most of it the margin.
WrenchResult CalcWrench(std::span<const WrenchContact> contacts, const WrenchConfig& config);

/// Ferrari and Canny's epsilon in the L1 sense ("Planning optimal grasps", ICRA 1992): the radius
/// of the largest ball about the origin inside the hull of the wrenches of all contacts' cone edges
/// (16 a cone, normal component 1; torques divided by torque_scale). Signed: minus the distance of
/// the origin from the hull if it lies outside, 0 on the boundary and for hulls without interior
/// (two contacts) that hold it. Above 0 if and only if the contacts are force closure.
double CalcMargin(std::span<const WrenchContact> contacts, double mu, double torque_scale);

/// The same numbers in lists, as the scripting layer gives them (P and N: #contacts x 3).
/// @throws InputError if their counts differ.
std::vector<WrenchContact> MakeWrenchContacts(const MatrixX3& P, const MatrixX3& N);

}  // namespace pregrasp
