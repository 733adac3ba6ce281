#pragma once

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/core/check.h"
#include "app/core/json_reader.h"
#include "app/core/json_values.h"
#include "app/scene/finger.h"
#include "app/scene/shape.h"

namespace pregrasp::fields {

// Structs that name their fields once (VisitFields) as JSON and back.

using Json = nlohmann::ordered_json;

template <typename T>
concept HasFields = requires(T& t) {
  T::VisitFields(t, [](const char*, auto&) {});
};

// Writing: one overload a type.

inline Json Write(bool value) { return value; }
inline Json Write(int value) { return value; }
inline Json Write(std::uint64_t value) { return value; }
inline Json Write(double value) {
  PREGRASP_CHECK(std::isfinite(value), value);
  return value;
}
inline Json Write(const std::string& value) { return value; }
inline Json Write(Finger finger) { return FingerName(finger); }
inline Json Write(const Vector3& v) {
  PREGRASP_CHECK(v.allFinite(), v.transpose());
  return ToJson(v);
}
inline Json Write(const Quaternion& q) {
  PREGRASP_CHECK(q.coeffs().allFinite(), q.coeffs().transpose());
  return {q.w(), q.x(), q.y(), q.z()};
}
inline Json Write(const TriangleMesh& mesh) {
  Json vertices = Json::array(), faces = Json::array();
  for (Eigen::Index i = 0; i < mesh.V.rows(); ++i) {
    vertices.push_back(Write(Vector3(mesh.V.row(i).transpose())));
  }
  for (Eigen::Index i = 0; i < mesh.F.rows(); ++i) {
    faces.push_back({mesh.F(i, 0), mesh.F(i, 1), mesh.F(i, 2)});
  }
  return {{"V", std::move(vertices)}, {"F", std::move(faces)}};
}
template <HasFields T>
Json Write(const T& value);
template <typename T>
Json Write(const std::vector<T>& values);
template <typename T>
Json Write(const std::optional<T>& value) {
  return value ? Write(*value) : Json(nullptr);
}
template <typename T>
Json Write(const std::vector<T>& values) {
  Json list = Json::array();
  for (const T& value : values) list.push_back(Write(value));
  return list;
}
template <HasFields T>
Json Write(const T& value) {
  Json object = Json::object();
  T::VisitFields(value, [&](const char* name, const auto& field) { object[name] = Write(field); });
  return object;
}

// Reading.

inline void Read(const JsonReader& reader, bool& value) { value = reader.Bool(); }
inline void Read(const JsonReader& reader, int& value) {
  if (!reader.json().is_number_integer()) reader.Fail("a whole number");
  value = reader.json().get<int>();
}
inline void Read(const JsonReader& reader, std::uint64_t& value) {
  if (!reader.json().is_number_unsigned()) reader.Fail("a whole number from 0");
  value = reader.json().get<std::uint64_t>();
}
inline void Read(const JsonReader& reader, double& value) {
  if (reader.is_null()) reader.Fail("a number");
  value = reader.Number();
}
inline void Read(const JsonReader& reader, std::string& value) { value = reader.Text(); }
inline void Read(const JsonReader& reader, Finger& finger) {
  const std::string name = reader.Text();
  const auto found = std::find(kFingerNames.begin(), kFingerNames.end(), name);
  if (found == kFingerNames.end()) reader.Fail("the name of a finger");
  finger = static_cast<Finger>(found - kFingerNames.begin());
}
inline void Read(const JsonReader& reader, Vector3& v) { v = reader.Vec3(); }
inline void Read(const JsonReader& reader, Quaternion& q) { q = reader.Quat(); }
inline void Read(const JsonReader& reader, TriangleMesh& mesh) {
  const JsonReader vertices = reader["V"], faces = reader["F"];
  mesh.V.resize(static_cast<Eigen::Index>(vertices.size()), 3);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    mesh.V.row(static_cast<Eigen::Index>(i)) = vertices[i].Vec3().transpose();
  }
  mesh.F.resize(static_cast<Eigen::Index>(faces.size()), 3);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      int vertex = 0;
      Read(faces[i][k], vertex);
      if (vertex < 0 || vertex >= mesh.V.rows()) faces[i][k].Fail("the number of a vertex");
      mesh.F(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) = vertex;
    }
  }
}
template <HasFields T>
void Read(const JsonReader& reader, T& value);
template <typename T>
void Read(const JsonReader& reader, std::vector<T>& values);
template <typename T>
void Read(const JsonReader& reader, std::optional<T>& value) {
  if (reader.is_null()) {
    value.reset();
  } else {
    Read(reader, value.emplace());
  }
}
template <typename T>
void Read(const JsonReader& reader, std::vector<T>& values) {
  values.resize(reader.size());
  for (std::size_t i = 0; i < values.size(); ++i) Read(reader[i], values[i]);
}
template <HasFields T>
void Read(const JsonReader& reader, T& value) {
  T::VisitFields(value, [&](const char* name, auto& field) { Read(reader[name], field); });
}

}  // namespace pregrasp::fields
