#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include "bindings/lua_array.h"
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

// table.sort. Lua's own compares strings within C, where no hook counts: this one looks at the
// clock. A merge sort: stable, and an order that contradicts itself gives some order.
class Sorter {
 public:
  // Arguments 1, the list, and 2, the order or nil.
  Sorter(lua_State* L, int count) : L_(L), machine_(Machine::Of(L)), count_(count) {
    lua_createtable(L, count, 0);
    for (int i = 1; i <= count; ++i) {
      lua_geti(L, 1, i);
      lua_rawseti(L, kCopy, i);
    }
  }

  void Sort() {
    std::vector<int> order(count_), merged(count_);
    for (int i = 0; i < count_; ++i) order[i] = i + 1;
    for (std::int64_t width = 1; width < count_; width *= 2) {
      for (std::int64_t low = 0; low < count_; low += 2 * width) {
        Merge(order, merged, low, std::min<std::int64_t>(low + width, count_),
              std::min<std::int64_t>(low + 2 * width, count_));
      }
      order.swap(merged);
    }
    for (int i = 0; i < count_; ++i) {
      lua_rawgeti(L_, kCopy, order[i]);
      lua_seti(L_, 1, i + 1);
    }
  }

 private:
  static constexpr int kOrder = 2, kCopy = 3;            // on the stack
  static constexpr std::size_t kWorkPerCheck = 1000000;  // bytes compared, about 0.1 ms
  static constexpr std::size_t kWorkOfCall = 500;        // of a comparison, besides

  void Merge(const std::vector<int>& from, std::vector<int>& to, std::int64_t low,
             std::int64_t middle, std::int64_t high) {
    std::int64_t left = low, right = middle;
    for (std::int64_t i = low; i < high; ++i) {
      const bool take_right = left == middle || (right < high && IsLess(from[right], from[left]));
      to[i] = take_right ? from[right++] : from[left++];
    }
  }

  bool IsLess(int a, int b) {
    Work(kWorkOfCall);
    if (!lua_isnil(L_, kOrder)) lua_pushvalue(L_, kOrder);
    lua_rawgeti(L_, kCopy, a);
    lua_rawgeti(L_, kCopy, b);
    bool less = false;
    if (!lua_isnil(L_, kOrder)) {
      lua_call(L_, 2, 1);
      less = lua_toboolean(L_, -1) != 0;
      lua_pop(L_, 1);
      return less;
    }
    if (lua_type(L_, -1) == LUA_TSTRING && lua_type(L_, -2) == LUA_TSTRING) {
      std::size_t size_a = 0, size_b = 0;
      const char* text_a = lua_tolstring(L_, -2, &size_a);
      const char* text_b = lua_tolstring(L_, -1, &size_b);
      // Byte by byte, as Lua's < does in the C locale, which the program keeps.
      less = std::string_view(text_a, size_a) < std::string_view(text_b, size_b);
      Work(std::min(size_a, size_b));
    } else {
      less = lua_compare(L_, -2, -1, LUA_OPLT) != 0;
    }
    lua_pop(L_, 2);
    return less;
  }

  void Work(std::size_t amount) {
    work_ += amount;
    if (work_ < kWorkPerCheck) return;
    work_ = 0;
    machine_.CheckTime(L_);
  }

  lua_State* L_;
  Machine& machine_;
  int count_;
  std::size_t work_ = 0;
};

int Sort(lua_State* L) {
  const lua_Integer count = HonestLength(L, "sort");
  RequireFew(L, "sort", count);
  if (!lua_isnoneornil(L, 2)) luaL_checktype(L, 2, LUA_TFUNCTION);
  lua_settop(L, 2);
  Machine::Of(L).CheckTime(L);
  return Protect(L, [L, count] {
    Sorter(L, static_cast<int>(count)).Sort();
    return 0;
  });
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
  if (FindArray(L, 1)) {
    PushList(L, 1);
    lua_replace(L, 1);
  }
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
