#pragma once

#include <string>

#include "app/core/lua_api.h"

namespace pregrasp {

/// The name under which the manual has the value: of a bound function ("Session:settle"), of a
/// record's or object's class ("Body"), of the module; "" if it has none.
std::string FindManualName(lua_State* L, int index);

/// help(x) for the prompt, a lua_CFunction: x is a value or a name.
int PrintHelp(lua_State* L);

}  // namespace pregrasp
