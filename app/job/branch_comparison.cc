#include "app/job/branch_comparison.h"

#include <algorithm>

#include "app/core/json_difference.h"
#include "app/core/json_text.h"
#include "app/core/json_values.h"
#include "app/job/planner_settings.h"

namespace pregrasp {
namespace {

using Node = Timeline::Node;

// Whether the same was done, and came to the same.
bool IsSameStep(const Node& a, const Node& b) {
  return &a == &b || (a.command.verb == b.command.verb && a.command.options == b.command.options &&
                      !CompareContents(a.facts, b.facts));
}

std::vector<FactsDifference> CompareSettings(const JobState& a, const JobState& b) {
  const nlohmann::json one = PlannerSettings(a.config), other = PlannerSettings(b.config);
  std::vector<FactsDifference> differences;
  for (const auto& [name, value] : one.items()) {
    if (value == other.at(name)) continue;
    differences.push_back({name, FormatJson(value), FormatJson(other.at(name))});
  }
  return differences;
}

// What a scene says by name, but for its shapes.
nlohmann::ordered_json SceneValues(const Scene& scene) {
  nlohmann::ordered_json values;
  values["name"] = scene.name;
  for (const Body& body : scene.bodies) {
    nlohmann::ordered_json& value = values[body.name];
    value["p"] = ToJson(Vector3(body.X_WB.translation()));
    const Quaternion q(body.X_WB.linear());
    value["q"] = {q.w(), q.x(), q.y(), q.z()};
    value["friction"] = body.friction;
    if (body.movable()) value["mass"] = body.mass_properties->mass;
  }
  values["fingertips"] = {{"friction", scene.fingertips.friction},
                          {"max_force", scene.fingertips.max_force},
                          {"stiffness", scene.fingertips.stiffness},
                          {"damping", scene.fingertips.damping},
                          {"grasp_stiffness", scene.fingertips.grasp_stiffness}};
  values["gravity"] = ToJson(scene.gravity);
  return values;
}

std::optional<FactsDifference> CompareScenes(const Scene& a, const Scene& b) {
  std::optional<FactsDifference> first;
  VisitDifferences(SceneValues(a), SceneValues(b), [&](const JsonDifference& found) {
    first = {found.field, found.left, found.right};
    return false;
  });
  return first;
}

// The first difference of what was asked for.
std::optional<FactsDifference> CompareCommands(const Command& a, const Command& b) {
  if (a.verb != b.verb) return FactsDifference{"verb", VerbName(a.verb), VerbName(b.verb)};
  std::optional<FactsDifference> first;
  VisitDifferences(nlohmann::ordered_json(a.options), nlohmann::ordered_json(b.options),
                   [&](const JsonDifference& found) {
                     first = {found.field, found.left, found.right};
                     return false;
                   });
  return first;
}

// As the noise of an iteration is keyed (app/trajectory/mppi.cc).
std::optional<bool> FindSameNoise(const Timeline& a, const Node& left, const Timeline& b,
                                  const Node& right) {
  const auto* one = std::get_if<IterationFacts>(&left.facts.details);
  const auto* other = std::get_if<IterationFacts>(&right.facts.details);
  if (one == nullptr || other == nullptr) return std::nullopt;
  const auto screened = [](const Timeline& timeline, const Node& node) {
    return timeline.GetState(node)->optimization->screened;
  };
  return a.job().setup().seed == b.job().setup().seed && one->path == other->path &&
         one->iteration == other->iteration && screened(a, left) == screened(b, right);
}

}  // namespace

BranchComparison CompareBranches(const Timeline& left_timeline, const Node& left,
                                 const Timeline& right_timeline, const Node& right) {
  const std::vector<const Node*> a = PathTo(left), b = PathTo(right);
  BranchComparison comparison;
  comparison.scene = CompareScenes(left_timeline.job().scene(), right_timeline.job().scene());
  std::size_t i = 0;
  while (i < a.size() && i < b.size() && IsSameStep(*a[i], *b[i])) comparison.common = a[i++];
  if (i < a.size()) comparison.left = a[i];
  if (i < b.size()) comparison.right = b[i];
  if (comparison.left != nullptr && comparison.right != nullptr) {
    comparison.command = CompareCommands(a[i]->command, b[i]->command);
    if (comparison.command && comparison.command->field.rfind("settings", 0) == 0) {
      const auto settings =
          CompareSettings(*left_timeline.GetState(*a[i]), *right_timeline.GetState(*b[i]));
      if (!settings.empty()) comparison.command = settings.front();
    }
    if (a[i]->command.verb == b[i]->command.verb) {
      comparison.facts = CompareContents(a[i]->facts, b[i]->facts);
    }
    comparison.same_noise = FindSameNoise(left_timeline, *a[i], right_timeline, *b[i]);
  }
  comparison.settings =
      CompareSettings(*left_timeline.GetState(left), *right_timeline.GetState(right));
  return comparison;
}

}  // namespace pregrasp
