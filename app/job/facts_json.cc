#include "app/job/facts_json.h"

#include "app/core/json_difference.h"
#include "app/job/fields_json.h"

namespace pregrasp {
namespace {

using fields::Json;
using fields::Read;
using fields::Write;

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
  std::optional<FactsDifference> first;
  VisitDifferences(FactsToJson(left, 0), FactsToJson(right, 0), [&](const JsonDifference& found) {
    first = {found.field, found.left, found.right};
    return false;
  });
  return first;
}

}  // namespace pregrasp
