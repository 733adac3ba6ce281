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

}  // namespace pregrasp::internal
