#include "bindings/lua_array.h"

#include <fmt/format.h>

#include <algorithm>

namespace pregrasp {
namespace {

// Replaces a row of numbers on top by a view of it: what a script writes into it is refused, as it
// would be lost.
void SealRow(lua_State* L) {
  const auto count = static_cast<int>(lua_rawlen(L, -1));
  std::vector<double> row;
  bool whole = true;
  for (int i = 1; i <= count; ++i) {
    if (lua_rawgeti(L, -1, i) != LUA_TNUMBER) {
      lua_pop(L, 1);
      return;
    }
    whole = whole && lua_isinteger(L, -1) != 0;
    row.push_back(lua_tonumber(L, -1));
    lua_pop(L, 1);
  }
  if (row.empty()) return;
  lua_pop(L, 1);
  const auto push = [row = std::move(row), whole](lua_State* state, int i) {
    const double number = row[static_cast<std::size_t>(i)];
    if (whole) {
      lua_pushinteger(state, static_cast<lua_Integer>(number));
    } else {
      lua_pushnumber(state, number);
    }
  };
  LuaValue<LuaArray>::Push(L, {whole ? "integer" : "number", count, push});
}

// nil beyond the last one, as of a table
Pushed ArrayItem(lua_State* L, LuaArray& array, std::int64_t number) {
  if (number < 1 || number > array.count) {
    lua_pushnil(L);
  } else {
    array.push(L, static_cast<int>(number) - 1);
    if (lua_istable(L, -1) && FindSchema(L, -1) == nullptr) SealRow(L);
  }
  return {1};
}

Pushed ArrayToTable(lua_State* L, LuaArray& array) {
  PushArrayTable(L, array, array.count);
  return {1};
}

int ArrayCount(LuaArray& array) { return array.count; }

int ArrayToString(lua_State* L) {
  const auto array = FindObject<LuaArray>(L, 1);
  const std::string text = array ? fmt::format("Array({} {})", array->count, array->of) : "Array";
  lua_pushlstring(L, text.data(), text.size());
  return 1;
}

}  // namespace

std::shared_ptr<LuaArray> FindArray(lua_State* L, int index) {
  return FindObject<LuaArray>(L, index);
}

void PushArrayTable(lua_State* L, const LuaArray& array, int most) {
  const int count = std::min(array.count, most);
  luaL_checkstack(L, 10, "an array");
  lua_createtable(L, count, 0);
  for (int i = 0; i < count; ++i) {
    array.push(L, i);
    lua_rawseti(L, -2, i + 1);
  }
}

int PushList(lua_State* L, int index) {
  if (const auto array = FindArray(L, index)) {
    PushArrayTable(L, *array, array->count);
  } else {
    lua_pushvalue(L, index);
  }
  return lua_gettop(L);
}

const ClassInfo& ArrayClass() {
  static const FunctionInfo item = Item<&ArrayItem>("[]", "number");
  static const ClassInfo info{"Array",
                              {Query<&ArrayToTable>("table")},
                              {Property<&ArrayCount>("count")},
                              ArrayToString,
                              &item,
                              true};
  return info;
}

}  // namespace pregrasp
