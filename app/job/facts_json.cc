#include "app/job/facts_json.h"

#include "app/core/json_difference.h"
#include "app/job/fields_json.h"

namespace pregrasp {
namespace {

using fields::Json;
using fields::Read;
using fields::Write;

std::optional<FactsDifference> FindFirst(const Json& left, const Json& right, double tolerance) {
  std::optional<FactsDifference> first;
  VisitDifferences(left, right, [&](const JsonDifference& found) {
    if (found.distance && *found.distance <= tolerance) return true;
    first = {found.field, found.left, found.right};
    return false;
  });
  return first;
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

std::optional<FactsDifference> CompareFacts(const StepFacts& left, const StepFacts& right,
                                            double tolerance) {
  return FindFirst(FactsToJson(left, 0), FactsToJson(right, 0), tolerance);
}

std::optional<FactsDifference> CompareContents(const StepFacts& left, const StepFacts& right) {
  Json documents[] = {FactsToJson(left, 0), FactsToJson(right, 0)};
  for (Json& document : documents) {
    for (const char* field : {"id", "stage", "command"}) document.erase(field);
  }
  return FindFirst(documents[0], documents[1], 0.0);
}

}  // namespace pregrasp
