#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/core/error.h"
#include "app/core/lua_api.h"
#include "app/core/math.h"
#include "app/scene/finger.h"
#include "bindings/schema.h"

namespace pregrasp {

/// What a value is, for the "got" of a message: `-1`, `"left"`, `a table`, `nothing`.
std::string DescribeValue(lua_State* L, int index);

/// "a Path", "an Array".
std::string WithArticle(const std::string& name);

/// A table key as text.
std::string KeyText(lua_State* L, int index);

/// How a C++ type crosses into Lua. Read is strict (no text for numbers, no missing values) and
/// throws InputError whose field is `path`; it leaves the stack as it was. Push adds one value.
template <typename T>
struct LuaValue;

template <>
struct LuaValue<double> {  // finite
  static double Read(lua_State* L, int index, const std::string& path);
  static void Push(lua_State* L, double value) { lua_pushnumber(L, value); }
};

template <>
struct LuaValue<int> {
  static int Read(lua_State* L, int index, const std::string& path);
  static void Push(lua_State* L, int value) { lua_pushinteger(L, value); }
};

template <>
struct LuaValue<std::int64_t> {
  static std::int64_t Read(lua_State* L, int index, const std::string& path);
  static void Push(lua_State* L, std::int64_t value) { lua_pushinteger(L, value); }
};

template <>
struct LuaValue<bool> {
  static bool Read(lua_State* L, int index, const std::string& path);
  static void Push(lua_State* L, bool value) { lua_pushboolean(L, value); }
};

template <>
struct LuaValue<std::string> {
  static std::string Read(lua_State* L, int index, const std::string& path);
  static void Push(lua_State* L, const std::string& value) {
    lua_pushlstring(L, value.data(), value.size());
  }
};

template <>
struct LuaValue<Finger> {  // by name
  static Finger Read(lua_State* L, int index, const std::string& path);
  static void Push(lua_State* L, Finger finger) { lua_pushstring(L, FingerName(finger)); }
};

/// Pushes the list at `index` as a table: an array's items, else the value itself. @returns where.
int PushList(lua_State* L, int index);

/// A list {a, b, ..} without gaps and without other keys; its length. @throws InputError.
int CheckList(lua_State* L, int index, const std::string& path, const std::string& expected);

template <>
struct LuaValue<Vector3> {  // {x, y, z}
  static Vector3 Read(lua_State* L, int index, const std::string& path);
  static void Push(lua_State* L, const Vector3& v);
};

template <>
struct LuaValue<Quaternion> {  // {w, x, y, z}
  static void Push(lua_State* L, const Quaternion& q);
};

template <typename T>
struct LuaValue<std::vector<T>> {
  static std::vector<T> Read(lua_State* L, int index, const std::string& path) {
    index = PushList(L, index);
    std::vector<T> values(CheckList(L, index, path, "a list"));
    for (std::size_t i = 0; i < values.size(); ++i) {
      lua_rawgeti(L, index, static_cast<lua_Integer>(i) + 1);
      values[i] = LuaValue<T>::Read(L, -1, path + "[" + std::to_string(i + 1) + "]");
      lua_pop(L, 1);
    }
    lua_pop(L, 1);
    return values;
  }
  static void Push(lua_State* L, const std::vector<T>& values) {
    lua_createtable(L, static_cast<int>(values.size()), 0);
    for (std::size_t i = 0; i < values.size(); ++i) {
      LuaValue<T>::Push(L, values[i]);
      lua_rawseti(L, -2, static_cast<lua_Integer>(i) + 1);
    }
  }
};

template <typename T>
struct LuaValue<std::optional<T>> {
  static std::optional<T> Read(lua_State* L, int index, const std::string& path) {
    if (lua_isnoneornil(L, index)) return std::nullopt;
    return LuaValue<T>::Read(L, index, path);
  }
  static void Push(lua_State* L, const std::optional<T>& value) {
    value ? LuaValue<T>::Push(L, *value) : lua_pushnil(L);
  }
};

template <>
struct LuaValue<MatrixX3> {  // a list of rows
  static void Push(lua_State* L, const MatrixX3& matrix) {
    lua_createtable(L, static_cast<int>(matrix.rows()), 0);
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
      LuaValue<Vector3>::Push(L, matrix.row(i));
      lua_rawseti(L, -2, i + 1);
    }
  }
};

/// The fields of a table that follows a schema: unknown keys are refused at once, with the nearest
/// legal one.
class Fields {
 public:
  /// @param index  of the table; what is not there counts as an empty one.
  /// @param path   what the fields' names are prefixed with in messages ("object."), often "".
  /// @param where  file:line for messages, when it is not that of the running Lua code.
  /// @param positional  how many list entries {a, b, key = ..} may have besides.
  Fields(lua_State* L, int index, const Schema& schema, std::string path = "",
         std::string where = "", int positional = 0);

  bool Has(const std::string& key) const;

  template <typename T>
  T Required(const std::string& key) const {
    return Read<T>(key);
  }
  template <typename T>
  T Optional(const std::string& key, T otherwise) const {
    return Has(key) ? Read<T>(key) : otherwise;
  }
  template <typename T>
  std::optional<T> Find(const std::string& key) const {
    return Read<std::optional<T>>(key);
  }

  /// The list entry `number`, 1-based.
  template <typename T>
  T Positional(int number, const std::string& name) const {
    index_ == 0 ? lua_pushnil(L_) : static_cast<void>(lua_rawgeti(L_, index_, number));
    return ReadTop<T>(name);
  }

  /// Pushes the field's value, for those that are read by other means.
  void Push(const std::string& key) const;
  std::string Path(const std::string& key) const { return path_ + key; }
  const std::string& where() const { return where_; }

  /// @throws InputError about the field.
  [[noreturn]] void Refuse(const std::string& key, const std::string& expected) const;

 private:
  template <typename T>
  T Read(const std::string& key) const {
    Push(key);
    return ReadTop<T>(key);
  }

  template <typename T>
  T ReadTop(const std::string& key) const {
    try {
      T value = LuaValue<T>::Read(L_, -1, Path(key));
      lua_pop(L_, 1);
      return value;
    } catch (const InputError& error) {
      if (where_.empty() || !error.where().empty()) throw;
      throw InputError(where_, error.field(), error.expected(), error.got());
    }
  }

  lua_State* L_;
  int index_;  // 0 for an empty one
  const Schema& schema_;
  std::string path_, where_;
};

/// Builds a result: a table that can be read only by the names of its schema.
class RecordWriter {
 public:
  RecordWriter(lua_State* L, const Schema& schema) : L_(L), schema_(schema) {
    PushRecordTable(L, schema);
    table_ = lua_gettop(L);
  }

  template <typename T>
  RecordWriter& Set(const std::string& key, const T& value) {
    LuaValue<T>::Push(L_, value);
    return SetTop(key);
  }
  RecordWriter& Set(const std::string& key, const char* value) {
    lua_pushstring(L_, value);
    return SetTop(key);
  }
  /// Takes the value on top of the stack.
  RecordWriter& SetTop(const std::string& key);

 private:
  lua_State* L_;
  const Schema& schema_;
  int table_;
};

}  // namespace pregrasp
