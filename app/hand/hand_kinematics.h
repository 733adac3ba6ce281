#pragma once

#include <array>

#include "app/hand/hand_model.h"

namespace pregrasp {

/// Where every link and joint axis of a hand is.
struct HandPose {
  std::array<Matrix3, kMaxHandLinks> R_WL;
  std::array<Vector3, kMaxHandLinks> p_WL;
  std::array<Vector3, kMaxHandJoints> axis_W;  ///< joint j passes through p_WL[j + 1]

  RigidTransform X_WL(int link) const { return MakeTransform(R_WL[link], p_WL[link]); }
  Vector3 CalcPoint(int link, const Vector3& p_L) const { return R_WL[link] * p_L + p_WL[link]; }
};

/// Forward kinematics.
void CalcHandPose(const HandModel& hand, const RigidTransform& X_WH, const HandJoints& q,
                  HandPose* pose);

using PointJacobian = Eigen::Matrix<double, 3, kMaxHandDofs>;

/// d p_W / d(dofs) of the point that is fixed to `link` and now at p_W. The rotation part is the
/// left one: R_WH(theta) = exp(theta x) R_WH, theta in world axes.
void CalcPointJacobian(const HandModel& hand, const HandPose& pose, int link, const Vector3& p_W,
                       PointJacobian* J);

/// gradient += J^T f of the same Jacobian, without forming it.
void AddPointGradient(const HandModel& hand, const HandPose& pose, int link, const Vector3& p_W,
                      const Vector3& f_W, HandVector* gradient);

/// gradient += d(a.d_W)/d(dofs) for a direction d fixed to `link`, now d_W.
void AddDirectionGradient(const HandModel& hand, const HandPose& pose, int link, const Vector3& d_W,
                          const Vector3& a_W, HandVector* gradient);

/// One unit of every degree of freedom: what a step, a reference and the damping weigh it by.
inline constexpr double kUnitPosition = 0.05;  ///< [m]
inline constexpr double kUnitAngle = 0.5;      ///< [rad]
HandVector HandUnits();

/// The configuration that `step` leads to from `start`: p + dp, exp(theta x) R, q + dq. Joints are
/// not clamped.
HandConfiguration Advance(const HandConfiguration& start, const HandVector& step);

/// The step that leads from `start` to `end` (the inverse of Advance).
HandVector CalcStep(const HandConfiguration& start, const HandConfiguration& end);

/// Where the step from `a` to `b` has led by its share `s`.
HandConfiguration Interpolate(const HandConfiguration& a, const HandConfiguration& b, double s);

}  // namespace pregrasp
