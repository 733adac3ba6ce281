#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "app/core/math.h"

namespace pregrasp {

/// A value inside a JSON document that knows its own place, so that whatever is wrong with it is
/// reported as "FILE: bodies[1].mass: expected a number, got "heavy"". Every function throws
/// InputError. It refers to the document, which must outlive it.
class JsonReader {
 public:
  /// @param where  the document's file, with the line if it is one line of it.
  JsonReader(const nlohmann::json& document, std::string where);

  /// A key that must be there.
  JsonReader operator[](const std::string& key) const;
  /// An item of an array, from 0.
  JsonReader operator[](std::size_t index) const;

  bool is_null() const { return value_->is_null(); }
  /// The number of items of an array.
  std::size_t size() const;
  const nlohmann::json& json() const { return *value_; }

  /// null, which stands for a NaN, reads as a NaN.
  double Number() const;
  bool Bool() const;
  std::string Text() const;
  /// [x, y, z].
  Vector3 Vec3() const;
  /// Three rows of three.
  Matrix3 Mat3() const;
  /// A unit quaternion [w, x, y, z].
  Quaternion Quat() const;

  /// Throws InputError for this value.
  [[noreturn]] void Fail(const std::string& expected) const;

 private:
  const nlohmann::json* value_;
  std::string where_, path_;
};

}  // namespace pregrasp
