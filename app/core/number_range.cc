#include "app/core/number_range.h"

#include <cmath>

#include "app/core/error.h"
#include "app/core/text.h"

namespace pregrasp {

bool NumberRange::Contains(double value) const {
  const bool within = value >= low && value <= high;
  return within && (step == 0 || std::remainder(value, step) == 0.0);
}

std::string NumberRange::Text() const {
  const std::string text = FormatDouble(low) + " to " + FormatDouble(high);
  return *unit == '\0' ? text : text + ' ' + unit;
}

std::string NumberRange::Expected() const {
  const std::string numbers = step == 0   ? "a number"
                              : step == 1 ? "a whole number"
                              : step == 2 ? "an even number"
                                          : "a multiple of " + std::to_string(step);
  return numbers + " from " + Text();
}

void RequireWithin(const std::string& where, const std::string& field, const NumberRange& range,
                   double value) {
  if (!range.Contains(value)) {
    throw InputError(where, field, range.Expected(), FormatDouble(value));
  }
}

void RequireAtLeast(const std::string& where, const std::string& field, int least, int value) {
  if (value < least) {
    throw InputError(where, field, "at least " + std::to_string(least), std::to_string(value));
  }
}

}  // namespace pregrasp
