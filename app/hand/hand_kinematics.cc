#include "app/hand/hand_kinematics.h"

#include <cmath>

namespace pregrasp {
namespace {

// R * exp(angle axis x), the axis a unit vector (Rodrigues).
Matrix3 RotateAbout(const Matrix3& R, const Vector3& axis, double angle) {
  const double s = std::sin(angle);
  const double c = std::cos(angle);
  Matrix3 E = (1.0 - c) * axis * axis.transpose();
  E.diagonal().array() += c;
  E(0, 1) -= s * axis.z();
  E(1, 0) += s * axis.z();
  E(0, 2) += s * axis.y();
  E(2, 0) -= s * axis.y();
  E(1, 2) -= s * axis.x();
  E(2, 1) += s * axis.x();
  return R * E;
}

}  // namespace

void CalcHandPose(const HandModel& hand, const RigidTransform& X_WH, const HandJoints& q,
                  HandPose* pose) {
  pose->R_WL[0] = X_WH.linear();
  pose->p_WL[0] = X_WH.translation();
  for (int j = 0; j < hand.num_joints; ++j) {
    const HandJoint& joint = hand.joints[j];
    const Matrix3& R_WP = pose->R_WL[joint.parent];
    const Matrix3 R_WJ = R_WP * joint.X_PJ.linear();
    pose->p_WL[j + 1] = R_WP * joint.X_PJ.translation() + pose->p_WL[joint.parent];
    pose->axis_W[j] = R_WJ * joint.axis;
    pose->R_WL[j + 1] = RotateAbout(R_WJ, joint.axis, q[j]);
  }
}

void CalcPointJacobian(const HandModel& hand, const HandPose& pose, int link, const Vector3& p_W,
                       PointJacobian* J) {
  J->setZero();
  J->leftCols<3>().setIdentity();
  const Vector3 r = p_W - pose.p_WL[0];
  J->col(3) = Vector3(0.0, -r.z(), r.y());  // e_x x r, and so on
  J->col(4) = Vector3(r.z(), 0.0, -r.x());
  J->col(5) = Vector3(-r.y(), r.x(), 0.0);
  for (int j = hand.chain_begin[link]; j < link; ++j) {
    J->col(6 + j) = pose.axis_W[j].cross(p_W - pose.p_WL[j + 1]);
  }
}

void AddPointGradient(const HandModel& hand, const HandPose& pose, int link, const Vector3& p_W,
                      const Vector3& f_W, HandVector* gradient) {
  gradient->head<3>() += f_W;
  gradient->segment<3>(3) += (p_W - pose.p_WL[0]).cross(f_W);
  for (int j = hand.chain_begin[link]; j < link; ++j) {
    (*gradient)[6 + j] += pose.axis_W[j].dot((p_W - pose.p_WL[j + 1]).cross(f_W));
  }
}

void AddDirectionGradient(const HandModel& hand, const HandPose& pose, int link, const Vector3& d_W,
                          const Vector3& a_W, HandVector* gradient) {
  const Vector3 moment = d_W.cross(a_W);
  gradient->segment<3>(3) += moment;
  for (int j = hand.chain_begin[link]; j < link; ++j) {
    (*gradient)[6 + j] += pose.axis_W[j].dot(moment);
  }
}

HandVector HandUnits() {
  HandVector units = HandVector::Constant(kUnitAngle);
  units.head<3>().setConstant(kUnitPosition);
  return units;
}

HandConfiguration Advance(const HandConfiguration& start, const HandVector& step) {
  HandConfiguration end;
  const Vector3 theta = step.segment<3>(3);
  const double angle = theta.norm();
  // Through a quaternion, whose normalisation keeps R a rotation over any number of steps.
  Quaternion rotation = Quaternion::Identity();
  if (angle > 0.0) rotation = Quaternion(Eigen::AngleAxisd(angle, theta / angle));
  const Quaternion q_WH = (rotation * Quaternion(start.X_WH.linear())).normalized();
  end.X_WH = MakeTransform(q_WH, start.X_WH.translation() + step.head<3>());
  end.q = start.q + step.tail<kMaxHandJoints>();
  return end;
}

HandVector CalcStep(const HandConfiguration& start, const HandConfiguration& end) {
  HandVector step;
  step.head<3>() = end.X_WH.translation() - start.X_WH.translation();
  const Eigen::AngleAxisd rotation(Matrix3(end.X_WH.linear() * start.X_WH.linear().transpose()));
  step.segment<3>(3) = rotation.angle() * rotation.axis();
  step.tail<kMaxHandJoints>() = end.q - start.q;
  return step;
}

HandConfiguration Interpolate(const HandConfiguration& a, const HandConfiguration& b, double s) {
  return Advance(a, HandVector(s * CalcStep(a, b)));
}

}  // namespace pregrasp
