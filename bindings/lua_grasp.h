#pragma once

#include <vector>

#include "app/grasp/grasp_world.h"
#include "app/grasp/wrench.h"
#include "bindings/function.h"

namespace pregrasp {

/// The tests of a grasp as free functions: wrench{..} and ik{..}.
const std::vector<FunctionInfo>& GraspFunctions();
std::vector<const Schema*> GraspSchemas();

// Their results as records, and the parts of these.
void PushWrench(lua_State* L, const WrenchResult& result);
void PushIk(lua_State* L, const HandModel& hand, const IkResult& result);
void PushTransform(lua_State* L, const RigidTransform& X);
void PushJoints(lua_State* L, const HandModel& hand, const HandJoints& q);
void PushGraspContacts(lua_State* L, const std::vector<GraspContact>& contacts);

}  // namespace pregrasp
