#pragma once

#include <nlohmann/json.hpp>

#include "app/grasp/grasp_world.h"
#include "app/trajectory/plan.h"

namespace pregrasp {

/// Reads a plan that was made by hand: a list of 1 to 8 stages, each an object with `thumb`,
/// `index` or both, each an object
/// - `p_OC`: where the finger touches the object, which becomes the nearest place where a contact
///   may lie; left out while a finger that was on stays where it is;
/// - `p_WTargets`: where its spring pulls, in the world: a point for each of the stage's `knots`
///   knots, or one that it is held at.
/// @throws InputError that names the field: "stages[2].index.p_OC".
WorldPlan PlanFromJson(const nlohmann::json& stages, const GraspWorld& world, int knots);

}  // namespace pregrasp
