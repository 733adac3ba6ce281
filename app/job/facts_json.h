#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "app/job/step_facts.h"

namespace pregrasp {

/// A step as the object of a line of steps.jsonl (app/recording/README.md). A number that is not
/// finite is our bug (PREGRASP_CHECK): facts are finite.
nlohmann::ordered_json FactsToJson(const StepFacts& facts, int number);

/// The reverse, to the last bit.
/// @param where  file and line, for messages. @throws InputError for anything FactsToJson does not
/// write.
StepFacts FactsFromJson(const nlohmann::json& value, const std::string& where);

/// Where two steps first differ: the field's path ("details.rollouts[3].cost.total") and both
/// values.
struct FactsDifference {
  std::string field, left, right;
};
/// @param tolerance  the distance (CalcDistance) up to which numbers count as the same.
std::optional<FactsDifference> CompareFacts(const StepFacts& left, const StepFacts& right,
                                            double tolerance = 0.0);

/// The same of what two steps say, leaving out their ids and the commands that made them.
std::optional<FactsDifference> CompareContents(const StepFacts& left, const StepFacts& right);

}  // namespace pregrasp
