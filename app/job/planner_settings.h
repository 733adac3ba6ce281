#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <variant>
#include <vector>

#include "app/job/planner.h"
#include "app/scene/settings.h"

namespace pregrasp {

/// A value for a planner's field: numbers also for whole-number fields, names for choices.
using FieldValue = std::variant<double, bool, std::string>;

/// Sets one field by its name, "mppi.samples" or "graph.top_percent": the names that scripts, --set
/// and the manifest use.
/// @throws InputError for an unknown name, with the nearest one, or a value that does not fit.
void SetPlannerField(PlannerConfig& config, const std::string& name, const FieldValue& value);

/// Sets the fields of an object {"mppi.samples": 64, ..}, as commands have it.
/// @throws InputError as above, or for values that do not go together.
void ApplySettings(const nlohmann::json& settings, PlannerConfig& config);

/// Applies the settings that name a planner's field, and takes them out of the list.
/// @throws InputError("--set") as above, but leaves names of other roots alone.
void ApplyPlannerSettings(PlannerConfig& config, std::vector<Setting>& settings);

/// The names' roots ("mppi", "graph", ..), for messages.
std::vector<std::string> PlannerRoots();

/// Every field with its value, nested by stage.
nlohmann::json PlannerConfigJson(const PlannerConfig& config);
/// The same by full names, as ApplySettings takes them.
nlohmann::json PlannerSettings(const PlannerConfig& config);

}  // namespace pregrasp
