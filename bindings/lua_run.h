#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "app/core/lua_api.h"
#include "bindings/schema.h"

namespace pregrasp {

/// What scripts read finished runs with: pg.load and its class.
const std::vector<FunctionInfo>& RunFunctions();
const ClassInfo& RunClass();
std::vector<const Schema*> RunSchemas();

/// Pushes a document: lists and objects as tables, null as nil.
void PushJson(lua_State* L, const nlohmann::json& value);

}  // namespace pregrasp
