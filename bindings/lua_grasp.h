#pragma once

#include <vector>

#include "bindings/function.h"

namespace pregrasp {

/// The tests of a grasp as free functions: wrench{..} and ik{..}.
const std::vector<FunctionInfo>& GraspFunctions();
std::vector<const Schema*> GraspSchemas();

}  // namespace pregrasp
