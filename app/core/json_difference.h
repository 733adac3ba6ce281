#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace pregrasp {

/// A place where two documents differ.
struct JsonDifference {
  std::string field;        ///< its path: "details.rollouts[3].cost.total"; "" for the whole
  std::string left, right;  ///< both values, as FormatJson; "nothing" where one has none
  /// Of two numbers, unless both are whole: CalcDistance.
  std::optional<double> distance;
};

/// |a - b| over the largest of |a|, |b| and 1: relative, but for what is small anyway.
double CalcDistance(double a, double b);

/// Calls visit with each place where two documents differ, in the order of the left one, until it
/// returns false. @returns whether it never did.
bool VisitDifferences(const nlohmann::ordered_json& left, const nlohmann::ordered_json& right,
                      const std::function<bool(const JsonDifference&)>& visit);

}  // namespace pregrasp
