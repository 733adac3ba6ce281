#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "app/scene/scene.h"

namespace pregrasp {

/// What summary.json says, from what the stages reported: every field of the schema
/// (app/recording/README.md) in its order, null where `given` has none, and scene, seed,
/// within_rules, physics.mu_tip, physics.max_force_N and physics.dt filled in where `given` does
/// not say otherwise. A field that the schema lacks, or a status that it does not list, is our bug
/// (PREGRASP_CHECK).
nlohmann::ordered_json BuildSummary(const nlohmann::json& given, const Scene& scene,
                                    std::uint64_t seed, double dt, const std::string& hash);

}  // namespace pregrasp
