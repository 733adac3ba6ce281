#pragma once

#include <vector>

#include "bindings/schema.h"

namespace pregrasp {

/// What scripts run studies of many scenes and seeds with: pg.eval.
const std::vector<FunctionInfo>& StudyFunctions();
std::vector<const Schema*> StudySchemas();

}  // namespace pregrasp
