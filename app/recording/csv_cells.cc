#include "app/recording/csv_cells.h"

#include "app/core/text.h"

namespace pregrasp::internal {

void AppendCell(std::string& row, double value) { row.append(",").append(FormatDouble(value)); }

void AppendCells(std::string& row, const Vector3& v) {
  for (int i = 0; i < 3; ++i) AppendCell(row, v[i]);
}

void AppendCells(std::string& row, const Quaternion& q) {
  for (const double value : {q.w(), q.x(), q.y(), q.z()}) AppendCell(row, value);
}

void AppendCells(std::string& row, const RigidTransform& X) {
  AppendCells(row, Vector3(X.translation()));
  Quaternion q(X.linear());
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  AppendCells(row, q);
}

void AppendVectorNames(std::string& row, const std::string& stem) {
  for (const char* axis : {"_x", "_y", "_z"}) row.append(",").append(stem).append(axis);
}

void AppendQuaternionNames(std::string& row, const std::string& stem) {
  for (const char* axis : {"_w", "_x", "_y", "_z"}) row.append(",").append(stem).append(axis);
}

}  // namespace pregrasp::internal
