#pragma once

#include <Eigen/Dense>
#include <Eigen/Geometry>

namespace pregrasp {

using Vector2 = Eigen::Vector2d;
using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
using VectorX = Eigen::VectorXd;
using MatrixX = Eigen::MatrixXd;
using Quaternion = Eigen::Quaterniond;

/// N points or directions, one a row (#rows x 3), row-major so that a row is contiguous.
using MatrixX3 = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
/// Triangles as vertex indices (#rows x 3), counter-clockwise seen from outside.
using MatrixX3i = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// Rigid transform X_AB: the pose of frame B in frame A, so that p_A = X_AB * p_B.
using RigidTransform = Eigen::Isometry3d;

inline constexpr double kPi = 3.14159265358979323846;

inline double DegToRad(double degrees) { return degrees * (kPi / 180.0); }
inline double RadToDeg(double radians) { return radians * (180.0 / kPi); }

inline RigidTransform MakeTransform(const Matrix3& R_AB, const Vector3& p_AB) {
  RigidTransform X_AB = RigidTransform::Identity();
  X_AB.linear() = R_AB;
  X_AB.translation() = p_AB;
  return X_AB;
}

inline RigidTransform MakeTransform(const Quaternion& q_AB, const Vector3& p_AB) {
  return MakeTransform(q_AB.toRotationMatrix(), p_AB);
}

/// Points given in B, one a row, in A.
MatrixX3 TransformPoints(const RigidTransform& X_AB, const MatrixX3& P_B);

/// Rotation from roll, pitch, yaw about the fixed x, y and z axes [rad]: R = Rz(yaw) Ry(pitch)
/// Rx(roll).
Matrix3 RotationFromRpy(const Vector3& rpy);

/// The angle [rad, 0..pi] of the rotation that takes A to B.
double RotationAngle(const Matrix3& R_WA, const Matrix3& R_WB);

/// An orthonormal right-handed frame whose z axis is `nhat` (unit length); x and y are a
/// deterministic function of it (Duff et al., "Building an orthonormal basis, revisited", JCGT
/// 2017).
inline Matrix3 FrameFromNormal(const Vector3& nhat) {
  const double sign = std::copysign(1.0, nhat.z());
  const double a = -1.0 / (sign + nhat.z());
  const double b = nhat.x() * nhat.y() * a;
  Matrix3 R;
  R.col(0) = Vector3(1.0 + sign * nhat.x() * nhat.x() * a, sign * b, -sign * nhat.x());
  R.col(1) = Vector3(b, sign + nhat.y() * nhat.y() * a, -nhat.y());
  R.col(2) = nhat;
  return R;
}

}  // namespace pregrasp
