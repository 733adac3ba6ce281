#include "bindings/sandbox.h"

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "app/core/text.h"
#include "bindings/protect.h"
#include "bindings/value.h"

namespace pregrasp {
namespace {

// Registry keys, by address.
const char kGlobals = 0, kModules = 0, kEnvironmentMeta = 0;

int RefuseWrite(lua_State* L) {
  return luaL_error(L, "\"%s\" cannot be set: this table can only be read",
                    lua_type(L, 2) == LUA_TSTRING ? lua_tostring(L, 2) : luaL_typename(L, 2));
}

// Upvalue 1: the table behind the proxy.
int PairsOfProxy(lua_State* L) {
  lua_getglobal(L, "pairs");
  lua_pushvalue(L, lua_upvalueindex(1));
  lua_call(L, 1, 1);
  return 1;
}

int LengthOfProxy(lua_State* L) {
  lua_pushinteger(L, static_cast<lua_Integer>(lua_rawlen(L, lua_upvalueindex(1))));
  return 1;
}

// Whether require "pregrasp" has a field of that name, as `box`.
bool IsInModule(lua_State* L, const std::string& name) {
  const int top = lua_gettop(L);
  bool found = false;
  if (lua_rawgetp(L, LUA_REGISTRYINDEX, &kModules) == LUA_TTABLE &&
      lua_getfield(L, -1, "pregrasp") == LUA_TTABLE &&
      luaL_getmetafield(L, -1, "__index") == LUA_TTABLE) {
    lua_pushlstring(L, name.data(), name.size());
    found = lua_rawget(L, -2) != LUA_TNIL;
  }
  lua_settop(L, top);
  return found;
}

// An unknown variable is an error: it is a typing error more often than not.
int UnknownVariable(lua_State* L) {
  return Protect(L, [L]() -> int {
    if (lua_type(L, 2) != LUA_TSTRING) {
      lua_pushnil(L);
      return 1;
    }
    const std::string name = lua_tostring(L, 2);
    std::vector<std::string> known;
    lua_pushnil(L);
    while (lua_next(L, 1) != 0) {
      lua_pop(L, 1);
      if (lua_type(L, -1) == LUA_TSTRING) known.emplace_back(lua_tostring(L, -1));
    }
    std::sort(known.begin(), known.end());
    std::string nearest = FindNearest(name, known);
    if (IsInModule(L, name)) nearest = "pg." + name;
    throw InputError("unknown variable \"" + name + "\"" + FormatHint(nearest));
  });
}

// require(name): the program's own modules, else NAME.lua in the script's folder, run once.
int Require(lua_State* L) {
  return Protect(L, [L]() -> int {
    const std::string name = LuaValue<std::string>::Read(L, 1, "module");
    lua_settop(L, 1);
    lua_rawgetp(L, LUA_REGISTRYINDEX, &kModules);
    lua_pushvalue(L, 1);
    if (lua_rawget(L, 2) != LUA_TNIL) {
      if (lua_islightuserdata(L, -1)) throw InputError("module \"" + name + "\" requires itself");
      return 1;
    }
    std::string file = name + ".lua";
    for (char& c : file) {
      if (c == '.' && &c - file.data() < static_cast<std::ptrdiff_t>(name.size())) c = '/';
    }
    Machine& machine = Machine::Of(L);
    lua_pushvalue(L, 1);
    lua_pushlightuserdata(L, &machine);  // being loaded
    lua_rawset(L, 2);
    const auto forget = [&] {
      lua_pushvalue(L, 1);
      lua_pushnil(L);
      lua_rawset(L, 2);
    };
    try {
      machine.LoadFile(L, machine.files().FindForReading(
                              (machine.script_folder() / file).lexically_normal().string()));
    } catch (const InputError&) {
      forget();
      throw;
    }
    lua_pushvalue(L, 1);
    const int status = lua_pcall(L, 1, 1, 0);
    if (status != LUA_OK) {
      forget();
      return lua_error(L);
    }
    if (lua_isnil(L, -1)) {
      lua_pop(L, 1);
      lua_pushboolean(L, 1);
    }
    lua_pushvalue(L, 1);
    lua_pushvalue(L, -2);
    lua_rawset(L, 2);
    return 1;
  });
}

// math.randomseed() without a seed would draw one from the clock and an address.
int RandomSeed(lua_State* L) {
  if (lua_isnoneornil(L, 1)) {
    return luaL_error(L,
                      "math.randomseed: expected a seed; without one no two runs would be equal");
  }
  lua_pushvalue(L, lua_upvalueindex(1));
  lua_insert(L, 1);
  lua_call(L, lua_gettop(L) - 1, 0);
  return 0;
}

void SeedRandom(lua_State* L) {  // the math table is on top
  lua_getfield(L, -1, "randomseed");
  lua_pushvalue(L, -1);
  lua_pushinteger(L, static_cast<lua_Integer>(Machine::Of(L).config().seed));
  lua_call(L, 1, 0);
  lua_pushcclosure(L, RandomSeed, 1);
  lua_setfield(L, -2, "randomseed");
}

void LockStringMetatable(lua_State* L) {
  lua_pushliteral(L, "");
  lua_getmetatable(L, -1);
  lua_pushboolean(L, 0);
  lua_setfield(L, -2, "__metatable");
  lua_pop(L, 2);
}

}  // namespace

void MakeReadOnly(lua_State* L) {
  lua_newtable(L);  // the proxy
  lua_createtable(L, 0, 5);
  lua_pushvalue(L, -3);
  lua_setfield(L, -2, "__index");
  lua_pushcfunction(L, RefuseWrite);
  lua_setfield(L, -2, "__newindex");
  lua_pushvalue(L, -3);
  lua_pushcclosure(L, PairsOfProxy, 1);
  lua_setfield(L, -2, "__pairs");
  lua_pushvalue(L, -3);
  lua_pushcclosure(L, LengthOfProxy, 1);
  lua_setfield(L, -2, "__len");
  lua_pushboolean(L, 0);
  lua_setfield(L, -2, "__metatable");
  lua_setmetatable(L, -2);
  lua_replace(L, -2);
}

void OpenSandbox(lua_State* L) {
  luaL_requiref(L, LUA_GNAME, luaopen_base, 1);
  ReplaceBaseFunctions(L);
  ReplaceXPCall(L);
  lua_pushcfunction(L, Require);
  lua_setfield(L, -2, "require");
  lua_pop(L, 1);
  const struct {
    const char* name;
    lua_CFunction open;
    void (*replace)(lua_State*);
  } libraries[] = {
      {LUA_STRLIBNAME, luaopen_string, ReplaceStringFunctions},
      {LUA_TABLIBNAME, luaopen_table, ReplaceTableFunctions},
      {LUA_MATHLIBNAME, luaopen_math, SeedRandom},
      {LUA_COLIBNAME, luaopen_coroutine, ReplaceCoroutineFunctions},
      {LUA_UTF8LIBNAME, luaopen_utf8, nullptr},
  };
  for (const auto& library : libraries) {
    luaL_requiref(L, library.name, library.open, 0);
    if (library.replace != nullptr) library.replace(L);
    MakeReadOnly(L);
    lua_setglobal(L, library.name);
  }
  LockStringMetatable(L);

  lua_pushglobaltable(L);
  lua_pushnil(L);
  lua_setfield(L, -2, "_G");  // each environment has itself under this name
  lua_pushnil(L);
  lua_setfield(L, -2, "load");
  lua_rawsetp(L, LUA_REGISTRYINDEX, &kGlobals);
  // luaL_requiref keeps the libraries unlocked in its own table, which scripts cannot reach.
  lua_newtable(L);
  lua_rawsetp(L, LUA_REGISTRYINDEX, &kModules);

  lua_createtable(L, 0, 2);
  lua_pushcfunction(L, UnknownVariable);
  lua_setfield(L, -2, "__index");
  lua_pushliteral(L, "environment");
  lua_setfield(L, -2, "__metatable");
  lua_rawsetp(L, LUA_REGISTRYINDEX, &kEnvironmentMeta);
}

void PushEnvironment(lua_State* L) {
  lua_newtable(L);
  lua_rawgetp(L, LUA_REGISTRYINDEX, &kGlobals);
  lua_pushnil(L);
  while (lua_next(L, -2) != 0) {
    lua_pushvalue(L, -2);
    lua_insert(L, -2);
    lua_rawset(L, -5);
  }
  lua_pop(L, 1);
  const int environment = lua_gettop(L);
  PushLoad(L, environment);
  lua_setfield(L, environment, "load");
  lua_pushvalue(L, environment);
  lua_setfield(L, environment, "_G");
  lua_rawgetp(L, LUA_REGISTRYINDEX, &kEnvironmentMeta);
  lua_setmetatable(L, environment);
}

void SetGlobalForAll(lua_State* L, const char* name) {
  lua_rawgetp(L, LUA_REGISTRYINDEX, &kGlobals);
  lua_insert(L, -2);
  lua_setfield(L, -2, name);
  lua_pop(L, 1);
}

void SetModule(lua_State* L, const char* name) {
  lua_rawgetp(L, LUA_REGISTRYINDEX, &kModules);
  lua_insert(L, -2);
  lua_setfield(L, -2, name);
  lua_pop(L, 1);
}

}  // namespace pregrasp
