#include "app/core/math.h"

namespace pregrasp {

MatrixX3 TransformPoints(const RigidTransform& X_AB, const MatrixX3& P_B) {
  return (P_B * X_AB.linear().transpose()).rowwise() + X_AB.translation().transpose();
}

Matrix3 RotationFromRpy(const Vector3& rpy) {
  return (Eigen::AngleAxisd(rpy.z(), Vector3::UnitZ()) *
          Eigen::AngleAxisd(rpy.y(), Vector3::UnitY()) *
          Eigen::AngleAxisd(rpy.x(), Vector3::UnitX()))
      .toRotationMatrix();
}

double RotationAngle(const Matrix3& R_WA, const Matrix3& R_WB) {
  const Quaternion q(Matrix3(R_WA.transpose() * R_WB));
  return 2.0 * std::atan2(q.vec().norm(), std::abs(q.w()));
}

}  // namespace pregrasp
