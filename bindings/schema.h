#pragma once

#include <string>
#include <vector>

#include "app/core/lua_api.h"

namespace pregrasp {

/// The named fields of a Lua table that a call takes (options) or gives (a result). Held against
/// lua/meta by a test. A static object: its address is its identity.
struct Schema {
  std::string name;
  std::vector<std::string> keys;

  bool Has(const std::string& key) const;
};

/// One function as Lua sees it. A static object.
struct FunctionInfo {
  std::string name;        ///< "settle"
  std::string parameters;  ///< "options", "point, count": their names, for messages
  lua_CFunction call = nullptr;
};

/// A class of userdata: what can be called on it and read from it.
struct ClassInfo {
  std::string name;
  std::vector<FunctionInfo> methods;
  std::vector<FunctionInfo> properties;
  lua_CFunction to_string = nullptr;   ///< null: the class's name
  const FunctionInfo* item = nullptr;  ///< what x[number] gives; null: nothing
  bool list = false;                   ///< pairs(x) goes through its items, not its properties
};

/// "unknown key "fricton" (did you mean "friction"?)", or with all legal keys when none is near.
std::string UnknownKeyMessage(const std::string& what, const std::string& key,
                              const std::vector<std::string>& legal);

/// Pushes a table for the fields of `schema`, in which other fields can be neither read nor set.
void PushRecordTable(lua_State* L, const Schema& schema);

/// Pushes the closure of a bound function.
void PushFunction(lua_State* L, const FunctionInfo& function);

/// Makes the userdata at `index`, whose content is gone, a closed object: reading, setting and
/// calling anything of it is an error that says so, and it is of no class any more. For finalizers:
/// allocates nothing.
void CloseObject(lua_State* L, int index);

/// Pushes the metatable of a class, made on first use.
void PushClassMetatable(lua_State* L, const ClassInfo& info, lua_CFunction destroy);

/// The schema of the record at `index`, the class of the object there; null when it is neither.
const Schema* FindSchema(lua_State* L, int index);
const ClassInfo* FindClass(lua_State* L, int index);

/// The userdata at `index` if it is of the class, else null.
void* TestClass(lua_State* L, int index, const ClassInfo& info);

}  // namespace pregrasp
