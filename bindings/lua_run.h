#pragma once

#include <vector>

#include "bindings/schema.h"

namespace pregrasp {

/// What scripts read finished runs with: pg.load and its class.
const std::vector<FunctionInfo>& RunFunctions();
const ClassInfo& RunClass();

}  // namespace pregrasp
