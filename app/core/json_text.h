#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace pregrasp {

// JSON as every file of a run has it: numbers as the shortest text that reads back as the same
// double, with ".0" where that text would read back as an integer; NaN and infinities as null;
// bytes that are not UTF-8 replaced; keys in the order of `value`. The same value gives the same
// bytes.

/// On one line, without blanks and without a line break at the end.
std::string FormatJson(const nlohmann::ordered_json& value);

/// For reading: two spaces of indent, what fits in 100 columns on one line, a line break at the
/// end.
std::string FormatJsonIndented(const nlohmann::ordered_json& value);

/// @param where  what is parsed, for messages. @throws InputError if it is not JSON.
nlohmann::json ParseJson(const std::string& text, const std::string& where);

}  // namespace pregrasp
