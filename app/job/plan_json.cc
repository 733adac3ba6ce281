#include "app/job/plan_json.h"

#include <fmt/format.h>

#include <optional>
#include <string>

#include "app/core/error.h"

namespace pregrasp {
namespace {

constexpr std::size_t kMostStages = 8;  // as paths.stages
constexpr double kFar = 1.0;            // [m]; a contact further off the object is a mistake

struct PlanReader {
  const GraspWorld& world;
  int knots;

  static Vector3 Point(const nlohmann::json& value, const std::string& field) {
    if (!value.is_array() || value.size() != 3)
      throw InputError("", field, "{x, y, z}", value.dump());
    Vector3 point;
    for (int i = 0; i < 3; ++i) {
      const nlohmann::json& number = value[static_cast<std::size_t>(i)];
      if (!number.is_number()) throw InputError("", field, "{x, y, z}", value.dump());
      point[i] = number.get<double>();
    }
    if (!point.allFinite()) throw InputError("", field, "finite numbers", value.dump());
    return point;
  }

  std::vector<Vector3> Targets(const nlohmann::json& list, const std::string& field) const {
    const auto count = static_cast<std::size_t>(knots);
    if (!list.is_array() || (list.size() != 1 && list.size() != count)) {
      throw InputError("", field, fmt::format("a list of one point, or of {}, one a knot", knots),
                       list.is_array() ? fmt::format("one of {}", list.size()) : list.dump());
    }
    std::vector<Vector3> targets;
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t i = list.size() == 1 ? 0 : k;
      targets.push_back(Point(list[i], fmt::format("{}[{}]", field, i + 1)));
    }
    return targets;
  }

  WorldPlan::Finger Read(Finger finger, const nlohmann::json& value, bool was_on,
                         const std::string& field) const {
    WorldPlan::Finger read;
    read.on = true;
    const bool given = value.contains("p_OC");
    if (given && was_on) {
      throw InputError("", field + ".p_OC",
                       "none: a finger changes its place only after a stage without contact",
                       "a point");
    }
    read.kept = was_on;
    if (!was_on) {
      if (!given) throw InputError("", field + ".p_OC", "a point on the object", "nothing");
      const Vector3 p_O = Point(value["p_OC"], field + ".p_OC");
      const GraspContact contact = world.ContactNear(finger, p_O);
      if ((contact.p_OC - p_O).norm() > kFar) {
        throw InputError("", field + ".p_OC", "a point on the object, in its frame [m]",
                         value["p_OC"].dump());
      }
      read.contact = {true, contact.p_OC, contact.nhat_O};
    }
    if (!value.contains("p_WTargets")) {
      throw InputError("", field + ".p_WTargets", "a list of points", "nothing");
    }
    read.p_WTargets = Targets(value["p_WTargets"], field + ".p_WTargets");
    return read;
  }
};

}  // namespace

WorldPlan PlanFromJson(const nlohmann::json& stages, const GraspWorld& world, int knots) {
  if (!stages.is_array() || stages.empty() || stages.size() > kMostStages) {
    throw InputError("", "stages", fmt::format("a list of 1 to {} stages", kMostStages),
                     stages.is_array() ? fmt::format("one of {}", stages.size()) : stages.dump());
  }
  const PlanReader reader{world, knots};
  WorldPlan plan;
  std::array<bool, kNumPlanningFingers> was_on{};
  for (std::size_t s = 0; s < stages.size(); ++s) {
    const std::string where = fmt::format("stages[{}]", s + 1);
    if (!stages[s].is_object()) throw InputError("", where, "a table of fingers", stages[s].dump());
    auto& stage = plan.stages.emplace_back();
    for (std::size_t f = 0; f < stage.size(); ++f) {
      const auto finger = static_cast<Finger>(f);
      const auto found = stages[s].find(FingerName(finger));
      if (found != stages[s].end()) {
        stage[f] = reader.Read(finger, *found, was_on[f], where + "." + FingerName(finger));
      }
      was_on[f] = stage[f].on;
    }
  }
  return plan;
}

}  // namespace pregrasp
