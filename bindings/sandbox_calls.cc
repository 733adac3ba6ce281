// xpcall and the functions of coroutine that resume and close. Lua runs an error's handler, and
// closes a coroutine that failed, with hooks off when the error came from a hook: code of the
// script would then be out of every limit's reach. So once a script is stopped, none of it runs
// again.
#include "bindings/protect.h"
#include "bindings/sandbox.h"

namespace pregrasp {
namespace {

// Upvalue 1: the script's own handler.
int HandleUnlessStopped(lua_State* L) {
  if (Machine::Of(L).stopped()) return 1;
  lua_pushvalue(L, lua_upvalueindex(1));
  lua_insert(L, 1);
  lua_call(L, lua_gettop(L) - 1, 1);
  return 1;
}

int XPCall(lua_State* L) {
  luaL_checktype(L, 2, LUA_TFUNCTION);
  lua_pushvalue(L, 2);
  lua_pushcclosure(L, HandleUnlessStopped, 1);
  lua_replace(L, 2);
  return lua_tocfunction(L, lua_upvalueindex(1))(L);
}

// Upvalue 1: the coroutine.
int ResumeWrapped(lua_State* L) {
  lua_State* co = lua_tothread(L, lua_upvalueindex(1));
  const int arguments = lua_gettop(L);
  if (!lua_checkstack(co, arguments)) return luaL_error(L, "too many arguments to resume");
  lua_xmove(L, co, arguments);
  int results = 0;
  int status = LUA_OK;
  {
    const Machine::Running running(co);
    status = lua_resume(co, L, arguments, &results);
  }
  if (status == LUA_OK || status == LUA_YIELD) {
    if (!lua_checkstack(L, results + 1)) return luaL_error(L, "too many results to resume");
    lua_xmove(co, L, results);
    return results;
  }
  Machine::Of(L).RaiseIfStopped(L);
  // One that is dead, or resumes another or itself, refuses and stays as it is: its frames are in
  // use. One that failed closes its variables.
  const int failure = lua_status(co);
  if (failure != LUA_OK && failure != LUA_YIELD) {
    const Machine::Running running(co);
    lua_resetthread(co);
  }
  lua_xmove(co, L, 1);
  if (status != LUA_ERRMEM && lua_type(L, -1) == LUA_TSTRING) {
    luaL_where(L, 1);
    lua_insert(L, -2);
    lua_concat(L, 2);
  }
  return lua_error(L);
}

int Wrap(lua_State* L) {
  luaL_checktype(L, 1, LUA_TFUNCTION);
  lua_State* co = lua_newthread(L);
  lua_pushvalue(L, 1);
  lua_xmove(L, co, 1);
  lua_pushcclosure(L, ResumeWrapped, 1);
  return 1;
}

// A chain of coroutines, each resuming the next, would else go on where the stopped one left.
int Resume(lua_State* L) {
  lua_State* co = lua_tothread(L, 1);
  const Machine::Running running(co == nullptr ? L : co);
  const int results = lua_tocfunction(L, lua_upvalueindex(1))(L);
  Machine::Of(L).RaiseIfStopped(L);
  return results;
}

int Close(lua_State* L) {
  Machine::Of(L).RaiseIfStopped(L);
  return lua_tocfunction(L, lua_upvalueindex(1))(L);
}

void Wrapped(lua_State* L, const char* name, lua_CFunction function) {
  lua_getfield(L, -1, name);
  lua_pushcclosure(L, function, 1);
  lua_setfield(L, -2, name);
}

}  // namespace

void ReplaceXPCall(lua_State* L) { Wrapped(L, "xpcall", XPCall); }

void ReplaceCoroutineFunctions(lua_State* L) {
  Wrapped(L, "wrap", Wrap);
  Wrapped(L, "resume", Resume);
  Wrapped(L, "close", Close);
}

}  // namespace pregrasp
