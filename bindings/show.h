#pragma once

#include <string>

#include "app/core/lua_api.h"

namespace pregrasp {

/// A value as a prompt shows it, without a line's end: a record or an object as rows of its fields,
/// a list of records as a table with their fields as columns, the rest in one line. Long lists are
/// cut, and say so. Properties of objects are read; no function of the script runs but __tostring.
/// @param width  of the terminal [characters].
std::string ShowValue(lua_State* L, int index, int width);

/// The same value within a line: `{1, 2, 3}`, `"left"`, `Body{..}`, `4 Contact`.
std::string ShowInline(lua_State* L, int index);

}  // namespace pregrasp
