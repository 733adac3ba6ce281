#pragma once

#include <string>

namespace pregrasp {

/// The numbers that a setting, a flag or a field of a scene may be: finite, both ends included.
struct NumberRange {
  double low = 0.0, high = 0.0;
  int step = 0;  ///< only multiples of it: 1 for whole numbers, 2 for even ones; 0 for any number
  const char* unit = "";

  /// False for NaN and infinities.
  bool Contains(double value) const;

  /// "0 to 10", "0.01 to 1 m".
  std::string Text() const;
  /// What a message says was expected: "a whole number from 4 to 4096", "a number from 0 to 1 m".
  std::string Expected() const;
};

/// @throws InputError(where, field) if `value` is not within `range`.
void RequireWithin(const std::string& where, const std::string& field, const NumberRange& range,
                   double value);

/// @throws InputError(where, field) if `value` is less than `least`.
void RequireAtLeast(const std::string& where, const std::string& field, int least, int value);

}  // namespace pregrasp
