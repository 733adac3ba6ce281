#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bindings/function.h"

namespace pregrasp {

/// A big list as a script holds it: not a table but a view, whose items are made when they are
/// asked for. Read only; a[1] to a[#a], ipairs, pairs, and table() for a copy.
struct LuaArray {
  std::string of;                             ///< what an item is, for people: "Vector3"
  int count = 0;                              ///< items
  std::function<void(lua_State*, int)> push;  ///< pushes an item, from 0; holds what it reads
};

const ClassInfo& ArrayClass();

template <>
struct LuaClass<LuaArray> {
  static const ClassInfo& info() { return ArrayClass(); }
  static const Session* session(const LuaArray& /*object*/) { return nullptr; }
};

template <>
struct LuaValue<LuaArray> {
  static void Push(lua_State* L, const LuaArray& array) {
    PushObject(L, std::make_shared<LuaArray>(array));
  }
};

/// Data that arrays share, counted as the script's memory.
template <typename T>
struct ArrayData {
  T value;
  MemoryClaim claim;
};
/// @param bytes  that the value holds outside of itself.
template <typename T>
std::shared_ptr<const T> ShareArrayData(lua_State* L, T value, std::size_t bytes) {
  auto data = std::make_shared<ArrayData<T>>();
  data->claim = ClaimMemory(L, sizeof(ArrayData<T>) + bytes);
  data->value = std::move(value);
  return {data, &data->value};
}

/// The rows of a matrix of three columns, which `owner` holds. @param offset  added to each entry.
template <typename Owner, typename Matrix>
LuaArray MakeRowArray(std::string of, std::shared_ptr<const Owner> owner, const Matrix& matrix,
                      typename Matrix::Scalar offset = 0) {
  return {std::move(of), static_cast<int>(matrix.rows()),
          [owner = std::move(owner), &matrix, offset](lua_State* L, int row) {
            lua_createtable(L, static_cast<int>(matrix.cols()), 0);
            for (int column = 0; column < matrix.cols(); ++column) {
              LuaValue<typename Matrix::Scalar>::Push(L, matrix(row, column) + offset);
              lua_rawseti(L, -2, column + 1);
            }
          }};
}

/// The value at `index` if it is an array, else null.
std::shared_ptr<LuaArray> FindArray(lua_State* L, int index);
/// Pushes at most the first `most` items of an array as a table.
void PushArrayTable(lua_State* L, const LuaArray& array, int most);

}  // namespace pregrasp
