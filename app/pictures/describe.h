#pragma once

#include <string>
#include <vector>

#include "app/dynamics/world.h"

namespace pregrasp {

/// "(60, 0, -1.5) mm" from metres.
std::string FormatMillimetres(const Vector3& v);

/// What happened between two states and why, for a picture: a sentence made from the numbers, then
/// rows of a table ("index force\t0.56 N").
/// @param contacts  of the step that led to `after`.
std::vector<std::string> DescribeStep(const World& world, const WorldState& before,
                                      const WorldState& after,
                                      const std::vector<ContactPoint>& contacts);

/// What one physics step did, in rows: overlap, slip, energy.
std::vector<std::string> DescribeTrace(const StepTrace& trace);

/// The scene in rows: what the object and its fingers are.
std::vector<std::string> DescribeScene(const Scene& scene);

}  // namespace pregrasp
