#include "app/recording/summary.h"

#include <algorithm>
#include <array>

#include "app/core/check.h"

namespace pregrasp {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<const char*, 5> kStatuses{"ok", "no_feasible_grasp", "motion_failed",
                                               "start_graspable", "interrupted"};

Json Fields(std::initializer_list<const char*> names) {
  Json fields = Json::object();
  for (const char* name : names) fields[name] = nullptr;
  return fields;
}

// Every field, in the order of the file.
Json EmptySummary() {
  Json summary = Fields(
      {"scene", "seed", "status", "within_rules", "n_paths", "n_screened", "r_suc", "r_suc_raw"});
  summary["grasps"] = Fields({"tried", "feasible", "fingers", "kept"});
  summary["start_grasps"] = Fields({"tried", "feasible", "certified"});
  summary["object_motion"] = Fields({"translation_m", "rotation_deg", "max_speed"});
  summary["contacts"] = nullptr;
  summary["switches"] = nullptr;
  summary["wrench"] = Fields({"mu", "margin", "min_normal_N", "forces"});
  summary["lift"] = Fields({"held", "height_m", "slip_mm"});
  summary["motion"] = Fields({"frames", "failed", "loosened", "max_tip_error_mm",
                              "min_clearance_mm", "max_joint_speed", "order"});
  summary["physics"] = Fields({"mu_tip", "max_force_N", "max_penetration_mm", "dt"});
  summary["counts"] = Fields({"nodes", "kept", "paths", "rollouts", "iterations"});
  summary["seconds"] =
      Fields({"total", "geometry", "graph", "trajectory", "grasp", "motion", "pictures"});
  summary["peak_rss_mb"] = nullptr;
  summary["hash"] = nullptr;
  return summary;
}

// Overwrites the fields of `summary` with those given, if any; nested fields one by one.
void FillIn(Json& summary, const nlohmann::json& given, const std::string& parent) {
  if (given.is_null()) return;
  PREGRASP_CHECK(given.is_object(), parent);
  for (const auto& [key, value] : given.items()) {
    PREGRASP_CHECK(summary.contains(key), parent + key);
    if (summary[key].is_object()) {
      FillIn(summary[key], value, parent + key + '.');
    } else {
      summary[key] = value;
    }
  }
}

}  // namespace

Json BuildSummary(const nlohmann::json& given, const Scene& scene, std::uint64_t seed, double dt,
                  const std::string& hash) {
  Json summary = EmptySummary();
  summary["scene"] = scene.name;
  summary["seed"] = seed;
  summary["within_rules"] = RuleDepartures(scene).empty();
  summary["physics"]["mu_tip"] = scene.fingertips.friction;
  summary["physics"]["max_force_N"] = scene.fingertips.max_force;
  summary["physics"]["dt"] = dt;
  FillIn(summary, given, "");
  summary["hash"] = hash;
  const Json& status = summary["status"];
  PREGRASP_CHECK(
      status.is_null() || std::find(kStatuses.begin(), kStatuses.end(), status) != kStatuses.end(),
      status);
  return summary;
}

}  // namespace pregrasp
