#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "app/core/number_range.h"
#include "app/job/planner.h"
#include "app/scene/settings.h"

namespace pregrasp {

/// A value for a planner's field: numbers also for whole-number fields, names for choices.
using FieldValue = std::variant<double, bool, std::string>;

/// What a setting may be while a success still means what the project's definitions call one: a
/// value beyond loosens success. Without bounds, no value can: what is found by such a search is
/// judged all the same.
struct SettingRule {
  std::optional<double> at_least, at_most;
  const char* definition = "";  ///< what then would no longer be so

  bool Allows(double value) const;
  /// "at least 1.5", "" without bounds.
  std::string Text() const;
};

/// One row of the table of a planner's settings. The command line's --set, scripts' options, the
/// manual, manifest.json and every message about a setting are made from it; its default is that of
/// the stage's config.
struct PlannerSetting {
  /// Where the value stands in a configuration.
  using Field = std::variant<double*, int*, bool*, KeyframeOrder*, PathOrder*>;

  std::string name;     ///< "mppi.samples"
  NumberRange range;    ///< of a number
  std::string meaning;  ///< one line
  Field (*field)(PlannerConfig&) = nullptr;
  SettingRule rule;

  std::string root() const { return name.substr(0, name.find('.')); }  ///< "mppi"
  std::string key() const { return name.substr(name.find('.') + 1); }  ///< "samples"
  bool is_number() const;
  std::vector<std::string> choices() const;  ///< the words that it may be, for a choice
  std::string Values() const;                ///< "0.01 to 1 m", "true or false"
  std::string Expected() const;              ///< the same for messages: "a number from 0.01 to 1 m"

  FieldValue Get(const PlannerConfig& config) const;
  /// The same, a whole number as one.
  nlohmann::json GetJson(const PlannerConfig& config) const;
  FieldValue Default() const { return Get({}); }
  /// @throws InputError whose field is the setting's name, for a value that does not fit.
  void Set(PlannerConfig& config, const FieldValue& value) const;
};

/// As it is typed: 0.5, true, reverse.
std::string FieldText(const FieldValue& value);

/// The table, by stage.
const std::vector<PlannerSetting>& SettingsTable();

/// @throws InputError for an unknown name, with the nearest one.
const PlannerSetting& FindPlannerSetting(const std::string& name);

/// Sets one field by its name. @throws InputError for an unknown name or a value that does not fit.
void SetPlannerField(PlannerConfig& config, const std::string& name, const FieldValue& value);

/// Sets the fields of an object {"mppi.samples": 64, ..}, as commands have it.
/// @throws InputError as above, or for values that do not go together.
void ApplySettings(const nlohmann::json& settings, PlannerConfig& config);

/// Applies the settings that name a planner's field, and takes them out of the list.
/// @throws InputError(setting.where) as above, but leaves names of other roots alone.
void ApplyPlannerSettings(PlannerConfig& config, std::vector<Setting>& settings);

/// @throws InputError for the first field that is out of its range: whoever filled in `config`.
void CheckPlannerSettings(const PlannerConfig& config);

/// The names' roots ("mppi", "graph", ..), for messages.
std::vector<std::string> PlannerRoots();

/// Every field with its value, nested by stage.
nlohmann::json PlannerConfigJson(const PlannerConfig& config);
/// The same by full names, as ApplySettings takes them.
nlohmann::json PlannerSettings(const PlannerConfig& config);

/// The settings that loosen success, one sentence each; empty means within the rules.
std::vector<std::string> RuleDepartures(const PlannerConfig& config);

/// Those of the scene and those of the settings: a plan's within_rules is that there are none.
std::vector<std::string> RuleDepartures(const Scene& scene, const PlannerConfig& config);

}  // namespace pregrasp
