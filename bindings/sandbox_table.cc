#include "bindings/protect.h"
#include "bindings/sandbox.h"

namespace pregrasp {
namespace {

constexpr lua_Integer kMaxElements = 4000000;  // of one call: well under a second

void RequireFew(lua_State* L, const char* function, lua_Integer count) {
  if (count > kMaxElements) {
    luaL_error(L, "table.%s: expected at most %I elements, got %I", function, kMaxElements, count);
  }
}

// A length that lies sends Lua's own loops around 2^63 times, out of reach of every limit.
lua_Integer HonestLength(lua_State* L, const char* function) {
  luaL_checktype(L, 1, LUA_TTABLE);
  if (luaL_getmetafield(L, 1, "__len") != LUA_TNIL) {
    luaL_error(L, "table.%s: expected a table without __len", function);
  }
  return static_cast<lua_Integer>(lua_rawlen(L, 1));
}

// Calls Lua's own function, upvalue 1, with the same arguments.
int CallOriginal(lua_State* L) {
  Machine::Of(L).CheckTime(L);
  return lua_tocfunction(L, lua_upvalueindex(1))(L);
}

int Insert(lua_State* L) {
  RequireFew(L, "insert", lua_gettop(L) > 2 ? HonestLength(L, "insert") : 0);
  HonestLength(L, "insert");
  return CallOriginal(L);
}

int Remove(lua_State* L) {
  RequireFew(L, "remove", lua_gettop(L) > 1 ? HonestLength(L, "remove") : 0);
  HonestLength(L, "remove");
  return CallOriginal(L);
}

int Sort(lua_State* L) {
  RequireFew(L, "sort", HonestLength(L, "sort"));
  return CallOriginal(L);
}

// How many elements first..last has, as a number that cannot overflow.
lua_Integer CountBetween(lua_Integer first, lua_Integer last) {
  if (last < first) return 0;
  const lua_Unsigned count = static_cast<lua_Unsigned>(last) - static_cast<lua_Unsigned>(first);
  return count >= LUA_MAXINTEGER ? LUA_MAXINTEGER : static_cast<lua_Integer>(count) + 1;
}

int Move(lua_State* L) {
  RequireFew(L, "move", CountBetween(luaL_checkinteger(L, 2), luaL_checkinteger(L, 3)));
  return CallOriginal(L);
}

int Concat(lua_State* L) {
  luaL_checktype(L, 1, LUA_TTABLE);
  const lua_Integer last =
      lua_isnoneornil(L, 4) ? HonestLength(L, "concat") : luaL_checkinteger(L, 4);
  lua_settop(L, 4);
  RequireFew(L, "concat", CountBetween(luaL_optinteger(L, 3, 1), last));
  return CallOriginal(L);
}

int Unpack(lua_State* L) { return CallOriginal(L); }

}  // namespace

void ReplaceTableFunctions(lua_State* L) {
  const luaL_Reg replaced[] = {{"insert", Insert}, {"remove", Remove}, {"sort", Sort},
                               {"move", Move},     {"concat", Concat}, {"unpack", Unpack},
                               {nullptr, nullptr}};
  for (const luaL_Reg* entry = replaced; entry->name != nullptr; ++entry) {
    lua_getfield(L, -1, entry->name);
    lua_pushcclosure(L, entry->func, 1);
    lua_setfield(L, -2, entry->name);
  }
}

}  // namespace pregrasp
