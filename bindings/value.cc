#include "bindings/value.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "app/core/check.h"
#include "app/core/text.h"

namespace pregrasp {
namespace {

[[noreturn]] void Refuse(lua_State* L, int index, const std::string& path,
                         const std::string& expected) {
  throw InputError("", path, expected, DescribeValue(L, index));
}

// A zero byte would end a message there.
std::string WithVisibleNul(std::string text) {
  for (std::size_t at = text.find('\0'); at != std::string::npos; at = text.find('\0', at)) {
    text.replace(at, 1, "\\0");
  }
  return text;
}

}  // namespace

std::string WithArticle(const std::string& name) {
  const bool vowel = std::strchr("AEIOaeio", name.empty() ? 'x' : name[0]) != nullptr;
  return (vowel ? "an " : "a ") + name;
}

std::string DescribeValue(lua_State* L, int index) {
  switch (lua_type(L, index)) {
    case LUA_TNONE:
    case LUA_TNIL:
      return "nothing";
    case LUA_TBOOLEAN:
      return lua_toboolean(L, index) != 0 ? "true" : "false";
    case LUA_TNUMBER:
      return lua_isinteger(L, index) != 0 ? std::to_string(lua_tointeger(L, index))
                                          : FormatDouble(lua_tonumber(L, index));
    case LUA_TSTRING: {
      constexpr std::size_t kMost = 40;
      std::size_t size = 0;
      const char* data = lua_tolstring(L, index, &size);
      const std::string text = WithVisibleNul({data, std::min(size, kMost)});
      return '"' + text + (size > kMost ? "..\"" : "\"");
    }
    default: {
      if (luaL_getmetafield(L, index, "__name") == LUA_TSTRING) {
        std::string name = lua_tostring(L, -1);
        lua_pop(L, 1);
        return WithArticle(name);
      }
      return std::string("a ") + luaL_typename(L, index);
    }
  }
}

std::string KeyText(lua_State* L, int index) {
  if (lua_type(L, index) != LUA_TSTRING) return DescribeValue(L, index);
  std::size_t size = 0;
  const char* data = lua_tolstring(L, index, &size);
  return WithVisibleNul({data, size});
}

double LuaValue<double>::Read(lua_State* L, int index, const std::string& path) {
  if (lua_type(L, index) != LUA_TNUMBER) Refuse(L, index, path, "a number");
  const double value = lua_tonumber(L, index);
  if (!std::isfinite(value)) Refuse(L, index, path, "a finite number");
  return value;
}

std::int64_t LuaValue<std::int64_t>::Read(lua_State* L, int index, const std::string& path) {
  int whole = 0;
  const lua_Integer value =
      lua_type(L, index) == LUA_TNUMBER ? lua_tointegerx(L, index, &whole) : 0;
  if (whole == 0) Refuse(L, index, path, "a whole number");
  return value;
}

int LuaValue<int>::Read(lua_State* L, int index, const std::string& path) {
  const std::int64_t value = LuaValue<std::int64_t>::Read(L, index, path);
  if (value < std::numeric_limits<int>::min() || value > std::numeric_limits<int>::max()) {
    Refuse(L, index, path, "a whole number within +-2147483647");
  }
  return static_cast<int>(value);
}

bool LuaValue<bool>::Read(lua_State* L, int index, const std::string& path) {
  if (!lua_isboolean(L, index)) Refuse(L, index, path, "true or false");
  return lua_toboolean(L, index) != 0;
}

std::string LuaValue<std::string>::Read(lua_State* L, int index, const std::string& path) {
  if (lua_type(L, index) != LUA_TSTRING) Refuse(L, index, path, "a text");
  std::size_t size = 0;
  const char* data = lua_tolstring(L, index, &size);
  // What takes it as C text would see the part before it only.
  if (std::memchr(data, 0, size) != nullptr) Refuse(L, index, path, "a text without a zero byte");
  return {data, size};
}

Finger LuaValue<Finger>::Read(lua_State* L, int index, const std::string& path) {
  if (lua_type(L, index) == LUA_TSTRING) {
    const std::string name = KeyText(L, index);
    for (int i = 0; i < kNumFingers; ++i) {
      if (name == kFingerNames[i]) return static_cast<Finger>(i);
    }
  }
  Refuse(L, index, path, "a finger (thumb, index, middle, ring or little)");
}

int CheckList(lua_State* L, int index, const std::string& path, const std::string& expected) {
  if (!lua_istable(L, index)) Refuse(L, index, path, expected);
  index = lua_absindex(L, index);
  const auto size = static_cast<lua_Integer>(lua_rawlen(L, index));
  lua_Integer count = 0;
  lua_pushnil(L);
  while (lua_next(L, index) != 0) {
    lua_pop(L, 1);
    const lua_Integer key = lua_isinteger(L, -1) != 0 ? lua_tointeger(L, -1) : 0;
    if (key < 1 || key > size) {
      throw InputError("", path, expected, "the key \"" + KeyText(L, -1) + "\"");
    }
    ++count;
  }
  if (count != size) throw InputError("", path, expected, "a list with gaps");
  if (size > std::numeric_limits<int>::max()) throw InputError("", path, expected, "too many");
  return static_cast<int>(size);
}

Vector3 LuaValue<Vector3>::Read(lua_State* L, int index, const std::string& path) {
  const std::string expected = "three numbers {x, y, z}";
  index = PushList(L, index);
  const int count = CheckList(L, index, path, expected);
  if (count != 3) throw InputError("", path, expected, std::to_string(count) + " of them");
  Vector3 v;
  for (int i = 0; i < 3; ++i) {
    lua_rawgeti(L, index, i + 1);
    v[i] = LuaValue<double>::Read(L, -1, path + "[" + std::to_string(i + 1) + "]");
    lua_pop(L, 1);
  }
  lua_pop(L, 1);
  return v;
}

void LuaValue<Vector3>::Push(lua_State* L, const Vector3& v) {
  lua_createtable(L, 3, 0);
  for (int i = 0; i < 3; ++i) {
    lua_pushnumber(L, v[i]);
    lua_rawseti(L, -2, i + 1);
  }
}

void LuaValue<Quaternion>::Push(lua_State* L, const Quaternion& q) {
  LuaValue<std::vector<double>>::Push(L, {q.w(), q.x(), q.y(), q.z()});
}

Fields::Fields(lua_State* L, int index, const Schema& schema, std::string path, std::string where,
               int positional)
    : L_(L), index_(0), schema_(schema), path_(std::move(path)), where_(std::move(where)) {
  if (lua_isnoneornil(L, index)) return;
  const std::string self = path_.empty() ? "" : path_.substr(0, path_.find_last_not_of('.') + 1);
  if (!lua_istable(L, index)) {
    throw InputError(where_, self, "a table with " + schema.keys.front() + " = .. and so on",
                     DescribeValue(L, index));
  }
  index_ = lua_absindex(L, index);
  std::vector<std::string> unknown;
  lua_pushnil(L);
  while (lua_next(L, index_) != 0) {
    lua_pop(L, 1);
    if (lua_isinteger(L, -1) != 0 && lua_tointeger(L, -1) >= 1 &&
        lua_tointeger(L, -1) <= positional) {
      continue;
    }
    if (lua_type(L, -1) != LUA_TSTRING || !schema.Has(KeyText(L, -1))) {
      unknown.push_back(KeyText(L, -1));
    }
  }
  if (unknown.empty()) return;
  const std::string key = *std::min_element(unknown.begin(), unknown.end());
  throw InputError(UnknownKeyMessage(
      where_.empty() ? self : where_ + (self.empty() ? "" : ": " + self), key, schema.keys));
}

bool Fields::Has(const std::string& key) const {
  Push(key);
  const bool present = !lua_isnil(L_, -1);
  lua_pop(L_, 1);
  return present;
}

void Fields::Push(const std::string& key) const {
  PREGRASP_CHECK(schema_.Has(key), schema_.name, key);
  if (index_ == 0) {
    lua_pushnil(L_);
    return;
  }
  lua_pushlstring(L_, key.data(), key.size());
  lua_rawget(L_, index_);
}

void Fields::Refuse(const std::string& key, const std::string& expected) const {
  Push(key);
  throw InputError(where_, Path(key), expected, DescribeValue(L_, -1));
}

RecordWriter& RecordWriter::SetTop(const std::string& key) {
  PREGRASP_CHECK(schema_.Has(key), schema_.name, key);
  lua_pushlstring(L_, key.data(), key.size());
  lua_insert(L_, -2);
  lua_rawset(L_, table_);
  return *this;
}

}  // namespace pregrasp
