#pragma once

#include <nlohmann/json.hpp>

#include "app/core/math.h"

namespace pregrasp {

/// [x, y, z].
inline nlohmann::ordered_json ToJson(const Vector3& v) { return {v.x(), v.y(), v.z()}; }

/// Three rows of three.
inline nlohmann::ordered_json ToJson(const Matrix3& M) {
  return {ToJson(Vector3(M.row(0))), ToJson(Vector3(M.row(1))), ToJson(Vector3(M.row(2)))};
}

/// The rotation as a unit quaternion [w, x, y, z] with w >= 0.
inline nlohmann::ordered_json QuaternionJson(const Matrix3& R) {
  Quaternion q(R);
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  return {q.w(), q.x(), q.y(), q.z()};
}

}  // namespace pregrasp
