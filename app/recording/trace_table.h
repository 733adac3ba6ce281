#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "app/dynamics/world.h"
#include "app/scene/scene.h"

namespace pregrasp {

/// What a physics step did (see app/recording/README.md): `contacts`, `max_penetration`,
/// `kinetic_energy` and `potential_energy`.
nlohmann::ordered_json TraceToJson(const StepTrace& trace, const Scene& scene);

/// One line of trace.jsonl, with its line break: `t`, the end of the step [s], then the same.
std::string FormatTraceRow(const StepTrace& trace, double t, const Scene& scene);

}  // namespace pregrasp
