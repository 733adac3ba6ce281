#include "app/job/facts_json.h"

#include <algorithm>

#include "app/core/json_text.h"
#include "app/job/fields_json.h"

namespace pregrasp {
namespace {

using fields::Json;
using fields::Read;
using fields::Write;

// The first place where two documents differ.
std::optional<FactsDifference> Compare(const Json& left, const Json& right,
                                       const std::string& path) {
  if (left == right) return std::nullopt;
  const auto join = [&](const std::string& key) { return path.empty() ? key : path + '.' + key; };
  if (left.is_object() && right.is_object()) {
    for (const auto& [key, value] : left.items()) {
      if (!right.contains(key)) return FactsDifference{join(key), FormatJson(value), "nothing"};
      if (auto found = Compare(value, right[key], join(key))) return found;
    }
    for (const auto& [key, value] : right.items()) {
      if (!left.contains(key)) return FactsDifference{join(key), "nothing", FormatJson(value)};
    }
  }
  if (left.is_array() && right.is_array()) {
    for (std::size_t i = 0; i < std::min(left.size(), right.size()); ++i) {
      if (auto found = Compare(left[i], right[i], path + '[' + std::to_string(i) + ']'))
        return found;
    }
    return FactsDifference{path, std::to_string(left.size()) + " items",
                           std::to_string(right.size()) + " items"};
  }
  return FactsDifference{path, FormatJson(left), FormatJson(right)};
}

}  // namespace

Json FactsToJson(const StepFacts& facts, int number) {
  return {
      {"number", number},
      {"id", facts.id},
      {"stage", facts.stage()},
      {"command", CommandToJson(facts.command)},
      {"t", Write(facts.t)},
      {"bodies", Write(facts.bodies)},
      {"fingers", Write(facts.fingers)},
      {"contacts", Write(facts.contacts)},
      {"details", std::visit([](const auto& details) { return Write(details); }, facts.details)}};
}

StepFacts FactsFromJson(const nlohmann::json& value, const std::string& where) {
  const JsonReader reader(value, where);
  StepFacts facts;
  facts.id = reader["id"].Text();
  facts.command = CommandFromJson(reader["command"].json(), where);
  Read(reader["t"], facts.t);
  Read(reader["bodies"], facts.bodies);
  if (facts.bodies.empty()) reader["bodies"].Fail("the object at least");
  Read(reader["fingers"], facts.fingers);
  Read(reader["contacts"], facts.contacts);
  facts.details = MakeDetails(facts.command.verb);
  std::visit([&](auto& details) { Read(reader["details"], details); }, facts.details);
  return facts;
}

std::optional<FactsDifference> CompareFacts(const StepFacts& left, const StepFacts& right) {
  return Compare(FactsToJson(left, 0), FactsToJson(right, 0), "");
}

}  // namespace pregrasp
