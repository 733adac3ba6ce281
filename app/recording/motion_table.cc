#include "app/recording/motion_table.h"

#include "app/core/text.h"

namespace pregrasp {
namespace {

void AppendPoseNames(std::string& out, const std::string& frame) {
  for (const char* axis : {"_x", "_y", "_z"}) out.append(",p_W").append(frame).append(axis);
  for (const char* axis : {"_w", "_x", "_y", "_z"}) out.append(",q_W").append(frame).append(axis);
}

void Append(std::string& out, double value) { out.append(",").append(FormatDouble(value)); }

void Append(std::string& out, const RigidTransform& X_WF) {
  for (int i = 0; i < 3; ++i) Append(out, X_WF.translation()[i]);
  Quaternion q(X_WF.linear());
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  for (const double value : {q.w(), q.x(), q.y(), q.z()}) Append(out, value);
}

}  // namespace

std::string MotionHeader() {
  std::string header = "t";
  AppendPoseNames(header, "O");
  AppendPoseNames(header, "H");
  for (const char* joint : kHandJointNames) header.append(",").append(joint);
  for (const char* finger : kFingerNames) header.append(",").append(finger).append("_on");
  return header + ",clearance_mm,tip_error_mm,loosened\n";
}

std::string MotionRow(const MotionFrameTask& task, const MotionFrame& frame) {
  std::string row = FormatDouble(task.t);
  Append(row, task.X_WB.front());
  Append(row, frame.configuration.X_WH);
  for (int j = 0; j < kNumHandJoints; ++j) Append(row, frame.configuration.q[j]);
  for (const Placement::Contact& contact : task.contacts) row.append(contact.on ? ",1" : ",0");
  Append(row, 1e3 * frame.clearance);
  Append(row, 1e3 * frame.tip_error);
  row.append(",").append(std::to_string(static_cast<int>(frame.rung)));
  return row + '\n';
}

}  // namespace pregrasp
