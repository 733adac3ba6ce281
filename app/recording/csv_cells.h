#pragma once

#include <string>

#include "app/core/math.h"

namespace pregrasp::internal {

/// Append cells to a row of a CSV table, each with a comma before it.
void AppendCell(std::string& row, double value);
void AppendCells(std::string& row, const Vector3& v);         ///< x, y, z
void AppendCells(std::string& row, const Quaternion& q);      ///< w, x, y, z as it is
void AppendCells(std::string& row, const RigidTransform& X);  ///< x, y, z; w >= 0, x, y, z

/// Append the names of such cells: "p_WO" gives ",p_WO_x,p_WO_y,p_WO_z".
void AppendVectorNames(std::string& row, const std::string& stem);
void AppendQuaternionNames(std::string& row, const std::string& stem);

/// The cells of one row, in turn. @throws InputError (all but the constructor) with `where`.
class CellReader {
 public:
  /// Both outlive this.
  CellReader(const std::string& where, const std::string& row) : where_(where), row_(row) {}

  std::string NextWord(const char* expected);
  double NextNumber();        ///< finite
  int NextChoice(int most);   ///< a whole number from 0
  Vector3 NextVector();       ///< x, y, z
  RigidTransform NextPose();  ///< x, y, z; a unit quaternion w, x, y, z
  void ExpectEnd() const;

 private:
  const std::string& where_;
  const std::string& row_;
  std::size_t at_ = 0;
};

}  // namespace pregrasp::internal
