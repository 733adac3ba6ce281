#include "app/core/json_difference.h"

#include <algorithm>
#include <cmath>

#include "app/core/json_text.h"

namespace pregrasp {
namespace {

using Json = nlohmann::ordered_json;
using Visit = std::function<bool(const JsonDifference&)>;

constexpr char kNothing[] = "nothing";

bool VisitValues(const Json& left, const Json& right, const std::string& path, const Visit& visit);

bool VisitObjects(const Json& left, const Json& right, const std::string& path,
                  const Visit& visit) {
  const auto join = [&](const std::string& key) { return path.empty() ? key : path + '.' + key; };
  for (const auto& [key, value] : left.items()) {
    const auto other = right.find(key);
    const bool goes_on = other == right.end() ? visit({join(key), FormatJson(value), kNothing, {}})
                                              : VisitValues(value, *other, join(key), visit);
    if (!goes_on) return false;
  }
  for (const auto& [key, value] : right.items()) {
    if (!left.contains(key) && !visit({join(key), kNothing, FormatJson(value), {}})) return false;
  }
  return true;
}

bool VisitArrays(const Json& left, const Json& right, const std::string& path, const Visit& visit) {
  for (std::size_t i = 0; i < std::min(left.size(), right.size()); ++i) {
    if (!VisitValues(left[i], right[i], path + '[' + std::to_string(i) + ']', visit)) return false;
  }
  return left.size() == right.size() || visit({path,
                                               std::to_string(left.size()) + " items",
                                               std::to_string(right.size()) + " items",
                                               {}});
}

bool VisitValues(const Json& left, const Json& right, const std::string& path, const Visit& visit) {
  if (left == right) return true;
  if (left.is_object() && right.is_object()) return VisitObjects(left, right, path, visit);
  if (left.is_array() && right.is_array()) return VisitArrays(left, right, path, visit);
  JsonDifference difference{path, FormatJson(left), FormatJson(right), {}};
  if (left.is_number() && right.is_number() &&
      (left.is_number_float() || right.is_number_float())) {
    difference.distance = CalcDistance(left.get<double>(), right.get<double>());
  }
  return visit(difference);
}

}  // namespace

double CalcDistance(double a, double b) {
  return std::abs(a - b) / std::max({std::abs(a), std::abs(b), 1.0});
}

bool VisitDifferences(const Json& left, const Json& right, const Visit& visit) {
  return VisitValues(left, right, "", visit);
}

}  // namespace pregrasp
