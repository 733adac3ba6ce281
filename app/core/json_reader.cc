#include "app/core/json_reader.h"

#include <cmath>
#include <limits>
#include <utility>

#include "app/core/error.h"
#include "app/core/json_text.h"

namespace pregrasp {

JsonReader::JsonReader(const nlohmann::json& document, std::string where)
    : value_(&document), where_(std::move(where)) {}

JsonReader JsonReader::operator[](const std::string& key) const {
  if (!value_->is_object()) Fail("an object");
  JsonReader field = *this;
  if (!field.path_.empty()) field.path_ += '.';
  field.path_ += key;
  const auto found = value_->find(key);
  if (found == value_->end()) throw InputError(where_, field.path_, "a value", "none");
  field.value_ = &*found;
  return field;
}

JsonReader JsonReader::operator[](std::size_t index) const {
  JsonReader item = *this;
  item.path_ += '[' + std::to_string(index) + ']';
  if (index >= size()) throw InputError(where_, item.path_, "a value", "none");
  item.value_ = &(*value_)[index];
  return item;
}

std::size_t JsonReader::size() const {
  if (!value_->is_array()) Fail("an array");
  return value_->size();
}

double JsonReader::Number() const {
  if (value_->is_null()) return std::numeric_limits<double>::quiet_NaN();
  if (!value_->is_number()) Fail("a number");
  return value_->get<double>();
}

bool JsonReader::Bool() const {
  if (!value_->is_boolean()) Fail("true or false");
  return value_->get<bool>();
}

std::string JsonReader::Text() const {
  if (!value_->is_string()) Fail("a string");
  return value_->get<std::string>();
}

Vector3 JsonReader::Vec3() const {
  if (size() != 3) Fail("three numbers");
  return {(*this)[0].Number(), (*this)[1].Number(), (*this)[2].Number()};
}

Matrix3 JsonReader::Mat3() const {
  if (size() != 3) Fail("three rows of three numbers");
  Matrix3 M;
  for (int i = 0; i < 3; ++i) M.row(i) = (*this)[static_cast<std::size_t>(i)].Vec3();
  return M;
}

Quaternion JsonReader::Quat() const {
  if (size() != 4) Fail("a quaternion [w, x, y, z]");
  Quaternion q((*this)[0].Number(), (*this)[1].Number(), (*this)[2].Number(), (*this)[3].Number());
  if (!(std::abs(q.norm() - 1.0) < 1e-6)) Fail("a quaternion [w, x, y, z] of length 1");
  return q;
}

void JsonReader::Fail(const std::string& expected) const {
  constexpr std::size_t kMaxShown = 60;
  std::string got = FormatJson(*value_);
  if (got.size() > kMaxShown) got = got.substr(0, kMaxShown) + "..";
  throw InputError(where_, path_, expected, got);
}

}  // namespace pregrasp
