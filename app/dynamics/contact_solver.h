#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "app/dynamics/contact_set.h"
#include "app/dynamics/motion.h"
#include "app/dynamics/world.h"

namespace pregrasp {

/// Velocities of one body scaled by the square root of its mass matrix: sqrt(m) v, then sqrt(I_P)
/// times w in the principal axes. In these coordinates a Jacobian row both measures a contact's
/// velocity and applies its impulse.
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// One contact point: the rows normal, tangent 1, tangent 2 for one or two movable bodies.
struct PointRows {
  std::array<Vector6, 3> J_first, J_second;
  int first = 0, second = -1;  ///< movable indices; second is -1 against a fixed body
  double phi = 0.0;            ///< gap [m]
  double bias = 0.0;           ///< the normal velocity may not fall below -bias [m/s]
  double friction = 0.0;
  double K_nn = 0.0, inv_K_nn = 0.0;                      ///< K = J M^-1 J^T
  double inv_K_11 = 0.0, inv_K_12 = 0.0, inv_K_22 = 0.0;  ///< inverse of the tangential block
  double inv_K_tt_max = 0.0;                              ///< 1 / its larger eigenvalue
  double inv_mass = 0.0;                                  ///< of the lighter body
  double lambda_n = 0.0, lambda_1 = 0.0, lambda_2 = 0.0;  ///< impulses [N s]
  Vector3 change = Vector3::Zero();       ///< of the impulses in this pair of sweeps [N s]
  Vector3 last_change = Vector3::Zero();  ///< in the pair before
  Vector3 jump = Vector3::Zero();         ///< between the two, by Accelerate
  double correction = 0.0;                ///< pseudo-impulse of the position correction [N s]
  double correction_bias = 0.0;
  int contact = 0, point = 0;  ///< where it came from
};

/// Two points of one contact whose normal impulses are solved together, or a single point.
struct PointPair {
  int a = 0, b = -1;                                ///< indices of points; b is -1 for a single one
  double K_ab = 0.0;                                ///< coupling of the normals
  double inv_aa = 0.0, inv_bb = 0.0, inv_ab = 0.0;  ///< inverse of their K
};

/// A finger's contact with the object: rows along the inward normal and two tangents, with the
/// compliance of spring and damper on all three (see app/dynamics/README.md).
struct FingerRows {
  std::array<Vector6, 3> J;
  double gamma = 0.0;                ///< compliance 1 / (h (h k + b)) [m/s per N s]
  Vector3 target = Vector3::Zero();  ///< velocity at which the spring would bring the point home
  double gap_velocity = 0.0;         ///< gap / h: taken off the normal target
  double friction = 0.0, max_impulse = 0.0;
  Matrix3 K = Matrix3::Zero();  ///< J M^-1 J^T + gamma
  Matrix3 inv_K = Matrix3::Zero();
  double inv_mass = 0.0;
  Vector3 lambda = Vector3::Zero();  ///< impulse on the object: inward, tangent 1, tangent 2
  bool sliding = false;              ///< held by the friction cone in the last sweep
  bool capped = false;               ///< held by the force cap in the last sweep
  int finger = 0;
  Matrix3 R_WC = Matrix3::Identity();  ///< columns tangent 1, tangent 2, outward normal
  Vector3 r_W = Vector3::Zero();       ///< contact point from the centre of mass

  /// A vector given along (inward, tangent 1, tangent 2), in W.
  Vector3 ToWorld(const Vector3& v) const {
    return R_WC.col(0) * v[1] + R_WC.col(1) * v[2] - R_WC.col(2) * v[0];
  }
};

/// Projected Gauss-Seidel over all contact points and fingers of one step, matrix-free,
/// warm-started, with circular friction cones. The memory is reused from step to step.
class ContactSolver {
 public:
  /// Sets up the rows of `contacts`; impulses start from `cache`.
  void SetContacts(const StepConfig& config, const std::vector<BodyKernel>& kernels,
                   const std::vector<BodyMotion>& motions, const std::vector<Contact>& contacts,
                   const std::vector<WorldState::CachedImpulse>& cache);

  /// Adds a finger on movable 0: position, friction, spring and starting impulse as filled in by
  /// the caller; Jacobian and K are set here.
  void AddFinger(const BodyKernel& kernel, const BodyMotion& motion, const FingerRows& rows);

  /// Velocity sweeps, then, if a pair overlaps, position-correction sweeps.
  void Solve(const StepConfig& config);

  std::span<const PointRows> points() const { return points_; }
  const std::vector<FingerRows>& fingers() const { return fingers_; }
  const Matrix3& frame(const PointRows& point) const { return frames_[point.contact]; }

  /// Scaled velocity of movable `i` after the contacts, and its scaled correction.
  const Vector6& velocity(int i) const { return y_[i]; }
  const Vector6& correction(int i) const { return z_[i]; }

  /// Impulse of a point on the contact's body b.
  Vector3 impulse_W(const PointRows& point) const {
    const Matrix3& R = frame(point);
    return R.col(2) * point.lambda_n + R.col(0) * point.lambda_1 + R.col(1) * point.lambda_2;
  }

  /// Velocity of b relative to a at a point, after the contacts, along the two tangents.
  Vector3 CalcSlipVelocity(const PointRows& point) const;

  /// Velocity of the object at the finger's point: inward, tangent 1, tangent 2.
  Vector3 CalcObjectVelocity(const FingerRows& finger) const;

  /// Sums of all impulses by movable; the impulses that the Simbody stepper applies.
  void SumImpulses(const std::vector<BodyMotion>& motions, const std::vector<Contact>& contacts,
                   std::vector<BodyImpulse>* impulses) const;

  /// The impulses to start the next step from.
  void SaveImpulses(const std::vector<Contact>& contacts,
                    std::vector<WorldState::CachedImpulse>* cache) const;

 private:
  double CalcBias(const StepConfig& config, const PointRows& row) const;
  double CalcStretch() const;
  void Accelerate(double stretch);
  void AddPairs(int first, int size);
  void AddPair(int a, int b, double K_ab);
  void CorrectPositions(const StepConfig& config, int max_sweeps);

  std::vector<Vector6> y_, z_;
  std::vector<PointRows> rows_;  ///< memory for the points
  std::span<PointRows> points_;
  std::vector<PointPair> pairs_;
  std::vector<FingerRows> fingers_;
  std::vector<Matrix3> frames_;  ///< by contact: tangent 1, tangent 2, normal
};

}  // namespace pregrasp
