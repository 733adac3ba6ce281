#pragma once

#include "app/core/lua_api.h"

namespace pregrasp {

/// Opens base, string, table, math, coroutine and utf8 in L, takes out or replaces what could leave
/// the sandbox, run without end or depend on addresses, and locks the rest. bindings/README.md
/// lists each change with its reason.
void OpenSandbox(lua_State* L);

/// Pushes a fresh environment: the globals, free to be changed by their one user, in which reading
/// an unknown variable is an error.
void PushEnvironment(lua_State* L);

/// Replaces the table on top by a proxy through which it can only be read.
void MakeReadOnly(lua_State* L);

/// Adds a global that all environments made from now on have; pops its value.
void SetGlobalForAll(lua_State* L, const char* name);

/// Makes `require(name)` give the value on top, and pops it.
void SetModule(lua_State* L, const char* name);

// The parts, each replacing functions of the library table on top of the stack.
void ReplaceBaseFunctions(lua_State* L);
void ReplaceStringFunctions(lua_State* L);
void ReplaceTableFunctions(lua_State* L);
void ReplaceXPCall(lua_State* L);
void ReplaceCoroutineFunctions(lua_State* L);

/// Pushes the `load` of the environment at index `environment`.
void PushLoad(lua_State* L, int environment);

/// Pushes what tostring gives in the sandbox: no addresses, which differ from run to run.
void PushText(lua_State* L, int index);

}  // namespace pregrasp
