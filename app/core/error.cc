#include "app/core/error.h"

#include <utility>

#include "app/core/check.h"
#include "app/core/text.h"

namespace pregrasp {
namespace {

// "where: field: expected .., got ..", with the parts that are empty left out.
std::string FormatInputError(const std::string& where, const std::string& field,
                             const std::string& expected, const std::string& got) {
  std::string line;
  if (!where.empty()) line += where + ": ";
  if (!field.empty()) line += field + ": ";
  line += "expected " + expected;
  if (!got.empty()) line += ", got " + got;
  return OneLine(line);
}

}  // namespace

InputError::InputError(std::string where, std::string field, std::string expected, std::string got)
    : std::runtime_error(FormatInputError(where, field, expected, got)),
      where_(std::move(where)),
      field_(std::move(field)),
      expected_(std::move(expected)),
      got_(std::move(got)) {}

InputError::InputError(const std::string& line) : std::runtime_error(OneLine(line)) {}

namespace internal {

void CheckFailed(const char* file, int line, const char* condition, const std::string& values) {
  std::string message = std::string(file) + ":" + std::to_string(line) + ": " + condition;
  if (!values.empty()) message += " with " + values;
  throw InternalError(message);
}

}  // namespace internal
}  // namespace pregrasp
