#include "app/recording/csv_cells.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "app/core/error.h"
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

std::string CellReader::NextWord(const char* expected) {
  if (!(at_ <= row_.size())) throw InputError(where_, "", expected, "the end of the line");
  const std::size_t end = std::min(row_.find(',', at_), row_.size());
  const std::string word = row_.substr(at_, end - at_);
  at_ = end + 1;
  return word;
}

double CellReader::NextNumber() {
  const std::string word = NextWord("a number");
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) {
    throw InputError(where_, "", "a finite number", word);
  }
  return value;
}

int CellReader::NextChoice(int most) {
  const double value = NextNumber();
  const auto choice = static_cast<int>(value);
  if (!(value >= 0.0 && value <= most && value == choice)) {
    throw InputError(where_, "", "a whole number from 0 to " + std::to_string(most),
                     FormatDouble(value));
  }
  return choice;
}

Vector3 CellReader::NextVector() {
  Vector3 v;
  for (int i = 0; i < 3; ++i) v[i] = NextNumber();
  return v;
}

RigidTransform CellReader::NextPose() {
  const Vector3 p_WF = NextVector();
  double wxyz[4];
  for (double& value : wxyz) value = NextNumber();
  const Quaternion q_WF(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
  constexpr double kUnit = 1e-6;  // far above what writing a rotation as text loses
  if (!(std::abs(q_WF.norm() - 1.0) <= kUnit)) {
    throw InputError(where_, "", "a unit quaternion", FormatDouble(q_WF.norm()));
  }
  return MakeTransform(q_WF.normalized(), p_WF);
}

void CellReader::ExpectEnd() const {
  if (at_ <= row_.size()) throw InputError(where_, "", "no more fields", row_.substr(at_));
}

}  // namespace pregrasp::internal
