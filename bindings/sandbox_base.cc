#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "bindings/protect.h"
#include "bindings/sandbox.h"

namespace pregrasp {
namespace {

int ToString(lua_State* L) {
  luaL_checkany(L, 1);
  PushText(L, 1);
  return 1;
}

int Print(lua_State* L) {
  std::string line;
  const int count = lua_gettop(L);
  for (int i = 1; i <= count; ++i) {
    PushText(L, i);
    std::size_t size = 0;
    const char* text = lua_tolstring(L, -1, &size);
    if (i > 1) line += '\t';
    line.append(text, size);
    lua_pop(L, 1);
  }
  line += '\n';
  std::fwrite(line.data(), 1, line.size(), stdout);
  std::fflush(stdout);  // a long script's progress is seen as it comes, in a pipe too
  return 0;
}

// A key of a table, while nothing changes the table: its text stays where it is.
struct Key {
  int rank = 0;  // numbers, strings, booleans; other kinds have no order and are left at the end
  double number = 0.0;
  std::string_view text;
  int slot = 0;  // in the list of keys as `next` gives them
};

bool Before(const Key& a, const Key& b) {
  if (a.rank != b.rank) return a.rank < b.rank;
  if (a.number != b.number) return a.number < b.number;
  if (a.text != b.text) return a.text < b.text;
  return a.slot < b.slot;
}

Key ReadKey(lua_State* L, int index, int slot) {
  Key key;
  key.slot = slot;
  switch (lua_type(L, index)) {
    case LUA_TNUMBER:
      key.number = lua_tonumber(L, index);
      break;
    case LUA_TSTRING: {
      std::size_t size = 0;
      const char* data = lua_tolstring(L, index, &size);
      key.rank = 1;
      key.text = {data, size};
      break;
    }
    case LUA_TBOOLEAN:
      key.rank = 2;
      key.number = lua_toboolean(L, index);
      break;
    default:
      key.rank = 3;
  }
  return key;
}

// Pushes a list of the keys of the table at `index` beyond 1..count, in order.
void PushSortedKeys(lua_State* L, int index, lua_Unsigned count) {
  lua_newtable(L);
  const int unsorted = lua_gettop(L);
  std::vector<Key> keys;
  Machine& machine = Machine::Of(L);
  lua_pushnil(L);
  while (lua_next(L, index) != 0) {
    lua_pop(L, 1);
    if (lua_isinteger(L, -1) && static_cast<lua_Unsigned>(lua_tointeger(L, -1)) - 1 < count)
      continue;
    const int slot = static_cast<int>(keys.size()) + 1;
    keys.push_back(ReadKey(L, -1, slot));
    lua_pushvalue(L, -1);
    lua_rawseti(L, unsorted, slot);
    if (slot % 65536 == 0) machine.CheckTime(L);
  }
  std::size_t work = 0;  // bytes compared: long texts take long
  std::sort(keys.begin(), keys.end(), [&](const Key& a, const Key& b) {
    constexpr std::size_t kWorkPerCheck = 1000000, kWorkOfCall = 50;
    work += kWorkOfCall + std::min(a.text.size(), b.text.size());
    if (work > kWorkPerCheck) {
      work = 0;
      machine.CheckTime(L);
    }
    return Before(a, b);
  });
  machine.CheckTime(L);
  lua_createtable(L, static_cast<int>(keys.size()), 0);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    lua_rawgeti(L, unsorted, keys[i].slot);
    lua_rawseti(L, -2, static_cast<lua_Integer>(i) + 1);
  }
  lua_replace(L, unsorted);
}

// Upvalues: the table, its other keys, how many whole keys 1..n come first, the last place given.
int NextPair(lua_State* L) {
  const lua_Integer count = lua_tointeger(L, lua_upvalueindex(3));
  lua_Integer place = lua_tointeger(L, lua_upvalueindex(4));
  for (;;) {
    ++place;
    if (place <= count) {
      lua_pushinteger(L, place);
    } else if (lua_rawgeti(L, lua_upvalueindex(2), place - count) == LUA_TNIL) {
      return 1;
    }
    lua_pushvalue(L, -1);
    if (lua_rawget(L, lua_upvalueindex(1)) != LUA_TNIL) break;
    lua_pop(L, 2);  // taken out of the table since
  }
  lua_pushinteger(L, place);
  lua_replace(L, lua_upvalueindex(4));
  return 2;
}

// pairs in an order that is the same in every run: 1..n, other numbers, strings, booleans. Lua's
// own follows hashes seeded by time and addresses, and would make equal runs differ.
int Pairs(lua_State* L) {
  return Protect(L, [L] {
    luaL_checkany(L, 1);
    if (luaL_getmetafield(L, 1, "__pairs") != LUA_TNIL) {
      lua_pushvalue(L, 1);
      lua_call(L, 1, 3);
      return 3;
    }
    luaL_checktype(L, 1, LUA_TTABLE);
    lua_settop(L, 1);
    const lua_Unsigned count = lua_rawlen(L, 1);
    PushSortedKeys(L, 1, count);
    lua_pushinteger(L, static_cast<lua_Integer>(count));
    lua_pushinteger(L, 0);
    lua_pushcclosure(L, NextPair, 4);
    return 1;
  });
}

// A finalizer runs with hooks off, where no limit reaches it.
int SetMetatable(lua_State* L) {
  if (lua_istable(L, 2)) {
    lua_pushliteral(L, "__gc");
    if (lua_rawget(L, 2) != LUA_TNIL) return luaL_error(L, "__gc is not available to scripts");
    lua_pop(L, 1);
  }
  return lua_tocfunction(L, lua_upvalueindex(1))(L);
}

int RawSet(lua_State* L) {
  luaL_checktype(L, 1, LUA_TTABLE);
  if (luaL_getmetafield(L, 1, "__metatable") == LUA_TBOOLEAN && !lua_toboolean(L, -1)) {
    return luaL_error(L, "this table can only be read");
  }
  lua_settop(L, 3);
  lua_rawset(L, 1);
  return 1;
}

// load(text or function, name, mode, env): text only, in the environment of the chunk it belongs
// to.
int Load(lua_State* L) {
  return Protect(L, [L]() -> int {
    std::string text;
    if (lua_type(L, 1) == LUA_TSTRING) {
      std::size_t size = 0;
      const char* data = lua_tolstring(L, 1, &size);
      text.assign(data, size);
    } else {
      luaL_checktype(L, 1, LUA_TFUNCTION);
      for (;;) {
        lua_pushvalue(L, 1);
        lua_call(L, 0, 1);
        if (lua_isnil(L, -1)) break;
        if (lua_type(L, -1) != LUA_TSTRING)
          throw InputError("reader function must return a string");
        std::size_t size = 0;
        const char* data = lua_tolstring(L, -1, &size);
        if (size == 0) break;
        text.append(data, size);
        if (text.size() > Machine::kMaxString) throw std::bad_alloc();
        lua_pop(L, 1);
      }
    }
    const std::string name = luaL_optstring(L, 2, "=(load)");
    const bool own_environment = lua_gettop(L) >= 4;
    if (luaL_loadbufferx(L, text.data(), text.size(), name.c_str(), "t") != LUA_OK) {
      lua_pushnil(L);
      lua_insert(L, -2);
      return 2;
    }
    lua_pushvalue(L, own_environment ? 4 : lua_upvalueindex(1));
    lua_setupvalue(L, -2, 1);
    return 1;
  });
}

}  // namespace

void PushText(lua_State* L, int index) {
  index = lua_absindex(L, index);
  const int kind = lua_type(L, index);
  if (kind == LUA_TNUMBER && std::isnan(lua_tonumber(L, index))) {
    lua_pushliteral(L, "nan");  // whose sign is the processor's
    return;
  }
  const bool has_address = kind == LUA_TTABLE || kind == LUA_TUSERDATA || kind == LUA_TFUNCTION ||
                           kind == LUA_TTHREAD || kind == LUA_TLIGHTUSERDATA;
  if (has_address) {
    if (luaL_getmetafield(L, index, "__tostring") == LUA_TNIL) {
      if (luaL_getmetafield(L, index, "__name") == LUA_TSTRING) return;
      lua_pushstring(L, lua_typename(L, kind));
      return;
    }
    lua_pop(L, 1);
  }
  luaL_tolstring(L, index, nullptr);
}

void ReplaceBaseFunctions(lua_State* L) {
  for (const char* name : {"dofile", "loadfile", "collectgarbage", "warn"}) {
    lua_pushnil(L);
    lua_setfield(L, -2, name);
  }
  lua_getfield(L, -1, "setmetatable");
  lua_pushcclosure(L, SetMetatable, 1);
  lua_setfield(L, -2, "setmetatable");
  const luaL_Reg replaced[] = {{"tostring", ToString},
                               {"print", Print},
                               {"pairs", Pairs},
                               {"rawset", RawSet},
                               {nullptr, nullptr}};
  luaL_setfuncs(L, replaced, 0);
}

void PushLoad(lua_State* L, int environment) {
  lua_pushvalue(L, environment);
  lua_pushcclosure(L, Load, 1);
}

}  // namespace pregrasp
