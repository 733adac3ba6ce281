#include "app/core/json_text.h"

#include <algorithm>
#include <cmath>

#include "app/core/error.h"
#include "app/core/text.h"

namespace pregrasp {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kColumns = 100;

std::string FormatNumber(double value) {
  if (!std::isfinite(value)) return "null";
  std::string text = FormatDouble(value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string FormatScalar(const Json& value) {
  if (value.is_number_float()) return FormatNumber(value.get<double>());
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string FormatKey(const std::string& key) { return FormatScalar(key); }

// On one line, with `blank` (empty or a space) after each comma and colon.
void AppendInline(std::string& out, const Json& value, const char* blank) {
  if (!value.is_structured()) {
    out += FormatScalar(value);
    return;
  }
  out += value.is_array() ? '[' : '{';
  bool first = true;
  for (const auto& [key, item] : value.items()) {
    if (!first) out.append(",").append(blank);
    first = false;
    if (value.is_object()) out.append(FormatKey(key)).append(":").append(blank);
    AppendInline(out, item, blank);
  }
  out += value.is_array() ? ']' : '}';
}

// A vector, a quaternion or the like, which is on one line whatever its length.
bool IsShortTuple(const Json& value) {
  return value.is_array() && value.size() <= 4 &&
         std::none_of(value.begin(), value.end(), [](const Json& v) { return v.is_structured(); });
}

// `used` columns of the line are taken already, before the value and by what follows it.
void AppendIndented(std::string& out, const Json& value, std::size_t indent, std::size_t used) {
  std::string line;
  AppendInline(line, value, " ");
  if (!value.is_structured() || IsShortTuple(value) || used + line.size() <= kColumns) {
    out += line;
    return;
  }
  const std::string margin(indent + 2, ' ');
  out += value.is_array() ? "[\n" : "{\n";
  bool first = true;
  for (const auto& [key, item] : value.items()) {
    if (!first) out += ",\n";
    first = false;
    const std::string label = value.is_object() ? FormatKey(key) + ": " : "";
    out.append(margin).append(label);
    AppendIndented(out, item, indent + 2, margin.size() + label.size() + 1);
  }
  out.append("\n").append(indent, ' ').append(value.is_array() ? "]" : "}");
}

}  // namespace

std::string FormatJson(const Json& value) {
  std::string out;
  AppendInline(out, value, "");
  return out;
}

std::string FormatJsonIndented(const Json& value) {
  std::string out;
  AppendIndented(out, value, 0, 0);
  out += '\n';
  return out;
}

nlohmann::json ParseJson(const std::string& text, const std::string& where) {
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::exception& error) {
    throw InputError(where, "", "JSON", error.what());
  }
}

}  // namespace pregrasp
