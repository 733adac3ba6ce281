#include "app/job/planner_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>
#include <type_traits>

#include "app/core/error.h"
#include "app/core/text.h"

namespace pregrasp {
namespace {

// The values that each kind of choice may have; what they are called.
template <typename Choice>
constexpr Choice kChoices[] = {};
template <>
constexpr KeyframeOrder kChoices<KeyframeOrder>[] = {KeyframeOrder::kReverse,
                                                     KeyframeOrder::kForward};
template <>
constexpr PathOrder kChoices<PathOrder>[] = {PathOrder::kExplore, PathOrder::kPaper};
const char* NameOf(KeyframeOrder order) { return KeyframeOrderName(order); }
const char* NameOf(PathOrder order) { return PathOrderName(order); }

std::string Show(const FieldValue& value) {
  const bool text = std::holds_alternative<std::string>(value);
  return text ? '"' + FieldText(value) + '"' : FieldText(value);
}

std::string Join(const std::vector<std::string>& words, const std::string& quote,
                 const std::string& separator) {
  std::string text;
  for (const std::string& word : words) {
    text += (text.empty() ? "" : separator) + quote + word + quote;
  }
  return text;
}

// One overload a type of field: whether the value fits, and if so takes it.
bool Take(const NumberRange& range, const FieldValue& value, double& field) {
  const double* number = std::get_if<double>(&value);
  if (number == nullptr || !range.Contains(*number)) return false;
  field = *number;
  return true;
}

bool Take(const NumberRange& range, const FieldValue& value, int& field) {
  double number = 0.0;
  if (!Take(range, value, number)) return false;
  field = static_cast<int>(number);
  return true;
}

bool Take(const NumberRange& /*range*/, const FieldValue& value, bool& field) {
  const bool* flag = std::get_if<bool>(&value);
  if (flag != nullptr) field = *flag;
  return flag != nullptr;
}

template <typename Choice>
bool Take(const NumberRange& /*range*/, const FieldValue& value, Choice& field) {
  const std::string* word = std::get_if<std::string>(&value);
  for (const Choice choice : kChoices<Choice>) {
    if (word == nullptr || *word != NameOf(choice)) continue;
    field = choice;
    return true;
  }
  return false;
}

FieldValue Value(double field) { return field; }
FieldValue Value(int field) { return static_cast<double>(field); }
FieldValue Value(bool field) { return field; }
template <typename Choice>
FieldValue Value(Choice field) {
  return std::string(NameOf(field));
}

nlohmann::json ToJson(double value) { return value; }
nlohmann::json ToJson(int value) { return value; }
nlohmann::json ToJson(bool value) { return value; }
template <typename Choice>
nlohmann::json ToJson(Choice value) {
  return NameOf(value);
}

// The words of a choice; none for a field of another kind.
template <typename T>
std::vector<std::string> WordsOf(const T& /*field*/) {
  std::vector<std::string> words;
  if constexpr (std::is_enum_v<T>) {
    for (const T choice : kChoices<T>) words.emplace_back(NameOf(choice));
  }
  return words;
}

FieldValue ParseValue(const std::string& text) {
  if (text == "true" || text == "false") return text == "true";
  double number = 0.0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  if (error == std::errc() && rest == end) return number;
  return text;
}

// Calls visit(field) with the setting's field in `config`, as it is typed there.
template <typename Visitor>
auto VisitField(const PlannerSetting& setting, PlannerConfig& config, const Visitor& visit) {
  return std::visit([&](auto* field) { return visit(*field); }, setting.field(config));
}

}  // namespace

bool SettingRule::Allows(double value) const {
  return (!at_least || value >= *at_least) && (!at_most || value <= *at_most);
}

std::string SettingRule::Text() const {
  std::string text;
  if (at_least) text = "at least " + FormatDouble(*at_least);
  if (at_most) text += (text.empty() ? "at most " : " and at most ") + FormatDouble(*at_most);
  return text;
}

bool PlannerSetting::is_number() const { return std::holds_alternative<double>(Default()); }

std::vector<std::string> PlannerSetting::choices() const {
  PlannerConfig config;
  return VisitField(*this, config, [](const auto& value) { return WordsOf(value); });
}

std::string PlannerSetting::Values() const {
  if (is_number()) return range.Text();
  if (std::holds_alternative<bool>(Default())) return "true or false";
  return Join(choices(), "", " or ");
}

std::string PlannerSetting::Expected() const {
  if (is_number()) return range.Expected();
  if (std::holds_alternative<bool>(Default())) return "true or false";
  return Join(choices(), "\"", " or ");
}

FieldValue PlannerSetting::Get(const PlannerConfig& config) const {
  PlannerConfig copy = config;
  return VisitField(*this, copy, [](const auto& value) { return Value(value); });
}

nlohmann::json PlannerSetting::GetJson(const PlannerConfig& config) const {
  PlannerConfig copy = config;
  return VisitField(*this, copy, [](const auto& value) { return ToJson(value); });
}

void PlannerSetting::Set(PlannerConfig& config, const FieldValue& value) const {
  const bool fits =
      VisitField(*this, config, [&](auto& target) { return Take(range, value, target); });
  if (!fits) throw InputError("", name, Expected(), Show(value));
}

std::string FieldText(const FieldValue& value) {
  if (const double* number = std::get_if<double>(&value)) return FormatDouble(*number);
  if (const bool* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  return std::get<std::string>(value);
}

const PlannerSetting& FindPlannerSetting(const std::string& name) {
  std::vector<std::string> names;
  for (const PlannerSetting& setting : SettingsTable()) {
    if (setting.name == name) return setting;
    names.push_back(setting.name);
  }
  const std::string nearest = FindNearest(name, names);
  throw InputError("", name,
                   nearest.empty() ? "the name of a planner's field" : '"' + nearest + '"',
                   "an unknown name");
}

void SetPlannerField(PlannerConfig& config, const std::string& name, const FieldValue& value) {
  FindPlannerSetting(name).Set(config, value);
}

void ApplySettings(const nlohmann::json& settings, PlannerConfig& config) {
  for (const auto& [name, value] : settings.items()) {
    FieldValue field;
    if (value.is_boolean()) {
      field = value.get<bool>();
    } else if (value.is_number()) {
      field = value.get<double>();
    } else {
      field = value.get<std::string>();
    }
    SetPlannerField(config, name, field);
  }
  config.Validate();
}

void ApplyPlannerSettings(PlannerConfig& config, std::vector<Setting>& settings) {
  const std::vector<std::string> roots = PlannerRoots();
  std::vector<Setting> left;
  for (const Setting& setting : settings) {
    const std::string root = setting.key.substr(0, setting.key.find('.'));
    if (std::find(roots.begin(), roots.end(), root) == roots.end()) {
      left.push_back(setting);
      continue;
    }
    try {
      SetPlannerField(config, setting.key, ParseValue(setting.value));
    } catch (const InputError& error) {
      throw InputError(setting.where, error.field(), error.expected(), error.got());
    }
  }
  settings = left;
}

void CheckPlannerSettings(const PlannerConfig& config) {
  PlannerConfig copy = config;
  for (const PlannerSetting& setting : SettingsTable()) setting.Set(copy, setting.Get(config));
}

std::vector<std::string> PlannerRoots() {
  std::set<std::string> roots;
  for (const PlannerSetting& setting : SettingsTable()) roots.insert(setting.root());
  return {roots.begin(), roots.end()};
}

nlohmann::json PlannerConfigJson(const PlannerConfig& config) {
  nlohmann::json all;
  for (const PlannerSetting& setting : SettingsTable()) {
    all[setting.root()][setting.key()] = setting.GetJson(config);
  }
  return all;
}

nlohmann::json PlannerSettings(const PlannerConfig& config) {
  nlohmann::json all;
  for (const PlannerSetting& setting : SettingsTable()) {
    all[setting.name] = setting.GetJson(config);
  }
  return all;
}

std::vector<std::string> RuleDepartures(const PlannerConfig& config) {
  std::vector<std::string> departures;
  for (const PlannerSetting& setting : SettingsTable()) {
    const FieldValue value = setting.Get(config);
    const double* number = std::get_if<double>(&value);
    if (number == nullptr || setting.rule.Allows(*number)) continue;
    const char* unit = setting.range.unit;
    departures.push_back(fmt::format("{} {}{}{} is not {}: {}", setting.name, FieldText(value),
                                     *unit == '\0' ? "" : " ", unit, setting.rule.Text(),
                                     setting.rule.definition));
  }
  return departures;
}

std::vector<std::string> RuleDepartures(const Scene& scene, const PlannerConfig& config) {
  std::vector<std::string> departures = RuleDepartures(scene);
  for (std::string& departure : RuleDepartures(config)) departures.push_back(std::move(departure));
  return departures;
}

}  // namespace pregrasp
