#include "app/job/planner_settings.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "app/core/error.h"
#include "app/core/text.h"

namespace pregrasp {
namespace {

// The one list of fields and their names. Config is PlannerConfig or const PlannerConfig.
template <typename Config, typename Visitor>
void VisitFields(Config& config, Visitor&& visit) {
  visit("cloud.points", config.cloud_points);
  visit("mesh.triangles", config.mesh.triangles);
  visit("mesh.convex_share", config.mesh.convex_share);
  visit("graph.samples", config.graph.samples);
  visit("graph.top_percent", config.graph.top_percent);
  visit("graph.min_tip_distance", config.graph.min_tip_distance);
  visit("paths.stages", config.stages);
  visit("mppi.samples", config.mppi.samples);
  visit("mppi.iterations", config.mppi.iterations);
  visit("mppi.sigma", config.mppi.sigma);
  visit("mppi.final_sigma", config.mppi.final_sigma);
  visit("mppi.temperature", config.mppi.temperature);
  visit("mppi.patience", config.mppi.patience);
  visit("mppi.progress", config.mppi.progress);
  visit("mppi.max_travel", config.mppi.max_travel);
  visit("mppi.stage_seconds", config.mppi.timing.stage_seconds);
  visit("mppi.knots", config.mppi.timing.knots);
  visit("mppi.hold_seconds", config.mppi.timing.hold_seconds);
  visit("mppi.no_contact", config.mppi.weights.no_contact);
  visit("mppi.slip", config.mppi.weights.slip);
  visit("mppi.effort", config.mppi.weights.effort);
  visit("mppi.unrest", config.mppi.weights.unrest);
  visit("mppi.speed", config.mppi.weights.speed);
  visit("mppi.tip_overlap", config.mppi.weights.tip_overlap);
  visit("mppi.tip_spacing", config.mppi.weights.tip_spacing);
  visit("mppi.fall", config.mppi.weights.fall);
  visit("certify.hold_seconds", config.certify.hold_seconds);
  visit("certify.max_hold_shift", config.certify.max_hold_shift);
  visit("certify.max_hold_turn_deg", config.certify.max_hold_turn_deg);
  visit("grasps.samples", config.grasp_samples);
  visit("grasps.points", config.placements.points);
  visit("grasps.pairs", config.placements.pairs);
  visit("grasps.spacing", config.placements.spacing);
  visit("grasps.f_min", config.completion.grasp.f_min);
  visit("grasps.may_drop", config.completion.grasp.may_drop);
  visit("grasps.max_refinement", config.completion.max_refinement);
  visit("grasps.max_refinements", config.completion.max_refinements);
  visit("grasps.max_solves", config.completion.max_solves);
  visit("grasps.starts", config.completion.grasp.kinematics.ik.max_starts);
  visit("lift.height", config.lift.height);
  visit("lift.closing_seconds", config.lift.closing_seconds);
  visit("lift.lift_seconds", config.lift.lift_seconds);
  visit("lift.hold_seconds", config.lift.hold_seconds);
  visit("lift.friction_reserve", config.lift.friction_reserve);
  visit("motion.order", config.motion.order);
  visit("motion.fps", config.motion_timing.fps);
  visit("motion.approach_seconds", config.motion_timing.approach_seconds);
  visit("motion.closing_seconds", config.motion_timing.closing_seconds);
  visit("motion.lift_seconds", config.motion_timing.lift_seconds);
  visit("motion.lift_height", config.motion_timing.lift_height);
  visit("motion.approach_distance", config.motion.approach_distance);
  visit("motion.keyframe_starts", config.motion.keyframe_starts);
  visit("motion.frame_starts", config.motion.frame_starts);
  visit("motion.smoothing_sweeps", config.motion.smoothing_sweeps);
}

std::vector<std::string> FieldNames() {
  std::vector<std::string> names;
  PlannerConfig config;
  VisitFields(config, [&](const char* name, const auto&) { names.emplace_back(name); });
  return names;
}

std::string RootOf(const std::string& name) { return name.substr(0, name.find('.')); }

std::string Show(const FieldValue& value) {
  if (const double* number = std::get_if<double>(&value)) return FormatDouble(*number);
  if (const bool* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  return '"' + std::get<std::string>(value) + '"';
}

// One overload a type of field: takes the value, or throws.
void Take(const std::string& name, const FieldValue& value, double& field) {
  const double* number = std::get_if<double>(&value);
  if (number == nullptr) throw InputError("", name, "a number", Show(value));
  field = *number;
}

void Take(const std::string& name, const FieldValue& value, int& field) {
  const double* number = std::get_if<double>(&value);
  if (number == nullptr || *number != std::floor(*number) || std::abs(*number) > 1e9) {
    throw InputError("", name, "a whole number", Show(value));
  }
  field = static_cast<int>(*number);
}

void Take(const std::string& name, const FieldValue& value, bool& field) {
  const bool* flag = std::get_if<bool>(&value);
  if (flag == nullptr) throw InputError("", name, "true or false", Show(value));
  field = *flag;
}

void Take(const std::string& name, const FieldValue& value, KeyframeOrder& field) {
  const std::string* word = std::get_if<std::string>(&value);
  for (const KeyframeOrder order : {KeyframeOrder::kReverse, KeyframeOrder::kForward}) {
    if (word != nullptr && *word == KeyframeOrderName(order)) {
      field = order;
      return;
    }
  }
  throw InputError("", name, R"("reverse" or "forward")", Show(value));
}

FieldValue ParseValue(const std::string& text) {
  if (text == "true" || text == "false") return text == "true";
  double number = 0.0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  if (error == std::errc() && rest == end) return number;
  return text;
}

nlohmann::json ToJson(KeyframeOrder order) { return KeyframeOrderName(order); }
template <typename T>
nlohmann::json ToJson(const T& value) {
  return value;
}

}  // namespace

void SetPlannerField(PlannerConfig& config, const std::string& name, const FieldValue& value) {
  bool found = false;
  VisitFields(config, [&](const char* field_name, auto& field) {
    if (name != field_name) return;
    found = true;
    Take(name, value, field);
  });
  if (found) return;
  const std::string nearest = FindNearest(name, FieldNames());
  throw InputError("", name,
                   nearest.empty() ? "the name of a planner's field" : '"' + nearest + '"',
                   "an unknown name");
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
    if (std::find(roots.begin(), roots.end(), RootOf(setting.key)) == roots.end()) {
      left.push_back(setting);
      continue;
    }
    try {
      SetPlannerField(config, setting.key, ParseValue(setting.value));
    } catch (const InputError& error) {
      throw InputError("--set", error.field(), error.expected(), error.got());
    }
  }
  settings = left;
}

std::vector<std::string> PlannerRoots() {
  std::set<std::string> roots;
  for (const std::string& name : FieldNames()) roots.insert(RootOf(name));
  return {roots.begin(), roots.end()};
}

nlohmann::json PlannerConfigJson(const PlannerConfig& config) {
  nlohmann::json all;
  VisitFields(config, [&](const std::string& name, const auto& field) {
    const std::size_t dot = name.find('.');
    all[name.substr(0, dot)][name.substr(dot + 1)] = ToJson(field);
  });
  return all;
}

nlohmann::json PlannerSettings(const PlannerConfig& config) {
  nlohmann::json all;
  VisitFields(config,
              [&](const std::string& name, const auto& field) { all[name] = ToJson(field); });
  return all;
}

}  // namespace pregrasp
