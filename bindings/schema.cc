#include "bindings/schema.h"

#include <algorithm>

#include "app/core/text.h"
#include "bindings/protect.h"
#include "bindings/value.h"

namespace pregrasp {
namespace {

std::vector<std::string> MemberNames(const ClassInfo& info) {
  std::vector<std::string> names;
  for (const FunctionInfo& method : info.methods) names.push_back(method.name);
  for (const FunctionInfo& property : info.properties) names.push_back(property.name);
  return names;
}

// Upvalue 1: the schema. Reached only when the table lacks the key.
int ReadMissingField(lua_State* L) {
  return Protect(L, [L]() -> int {
    const auto& schema = *static_cast<const Schema*>(lua_touserdata(L, lua_upvalueindex(1)));
    const std::string key = KeyText(L, 2);
    if (!schema.Has(key)) throw InputError(UnknownKeyMessage(schema.name, key, schema.keys));
    lua_pushnil(L);
    return 1;
  });
}

int RefuseNewField(lua_State* L) {
  return Protect(L, [L]() -> int {
    const auto& schema = *static_cast<const Schema*>(lua_touserdata(L, lua_upvalueindex(1)));
    throw InputError(UnknownKeyMessage(schema.name, KeyText(L, 2), schema.keys));
  });
}

// A record that has a sentence is that as text.
int RecordToText(lua_State* L) {
  lua_pushliteral(L, "text");
  if (lua_rawget(L, 1) != LUA_TSTRING) lua_pushliteral(L, "");
  return 1;
}

// #x of an object that has items: its property `count`. Upvalue: properties by name.
int ObjectLength(lua_State* L) {
  lua_pushliteral(L, "count");
  lua_rawget(L, lua_upvalueindex(1));
  lua_pushvalue(L, 1);
  lua_call(L, 1, 1);
  if (lua_Integer whole = 0; lua_numbertointeger(lua_tonumber(L, -1), &whole)) {
    lua_pushinteger(L, whole);
  }
  return 1;
}

// pairs(x) of a list: its items in order.
int ListPairs(lua_State* L) {
  lua_getglobal(L, "ipairs");
  lua_pushvalue(L, 1);
  lua_call(L, 1, 3);
  return 3;
}

// pairs(x) of an object: its properties as a table, by the script's own pairs. Upvalues: properties
// by name, the class.
int ObjectPairs(lua_State* L) {
  const auto& info = *static_cast<const ClassInfo*>(lua_touserdata(L, lua_upvalueindex(2)));
  lua_getglobal(L, "pairs");
  lua_createtable(L, 0, static_cast<int>(info.properties.size()));
  for (const FunctionInfo& property : info.properties) {
    lua_getfield(L, lua_upvalueindex(1), property.name.c_str());
    lua_pushvalue(L, 1);
    lua_call(L, 1, 1);
    lua_setfield(L, -2, property.name.c_str());
  }
  lua_call(L, 1, 3);
  return 3;
}

// Upvalues: methods by name, properties by name, the class.
int ReadMember(lua_State* L) {
  if (lua_isinteger(L, 2) != 0) {
    const auto& info = *static_cast<const ClassInfo*>(lua_touserdata(L, lua_upvalueindex(3)));
    if (info.item != nullptr) {
      PushFunction(L, *info.item);
      lua_insert(L, 1);
      lua_call(L, 2, 1);
      return 1;
    }
  }
  lua_pushvalue(L, 2);
  if (lua_rawget(L, lua_upvalueindex(1)) != LUA_TNIL) return 1;
  lua_pushvalue(L, 2);
  if (lua_rawget(L, lua_upvalueindex(2)) != LUA_TNIL) {
    lua_pushvalue(L, 1);
    lua_call(L, 1, 1);
    return 1;
  }
  return Protect(L, [L]() -> int {
    const auto& info = *static_cast<const ClassInfo*>(lua_touserdata(L, lua_upvalueindex(3)));
    throw InputError(UnknownKeyMessage(info.name, KeyText(L, 2), MemberNames(info)));
  });
}

int RefuseMember(lua_State* L) {
  return Protect(L, [L]() -> int {
    const auto& info = *static_cast<const ClassInfo*>(lua_touserdata(L, lua_upvalueindex(1)));
    if (info.list)
      throw InputError(info.name + ": can only be read; x:table() is a copy to change");
    const std::string key = KeyText(L, 2);
    const std::vector<std::string> names = MemberNames(info);
    if (std::find(names.begin(), names.end(), key) == names.end()) {
      throw InputError(UnknownKeyMessage(info.name, key, names));
    }
    throw InputError(info.name + ": \"" + key + "\" can only be read");
  });
}

void PushFunctions(lua_State* L, const std::vector<FunctionInfo>& functions) {
  lua_createtable(L, 0, static_cast<int>(functions.size()));
  for (const FunctionInfo& function : functions) {
    PushFunction(L, function);
    lua_setfield(L, -2, function.name.c_str());
  }
}

// What the metatable's __index, if it is `reader`, holds as upvalue number `upvalue`; else null.
const void* FindIdentity(lua_State* L, int index, lua_CFunction reader, int upvalue) {
  if (!lua_getmetatable(L, index)) return nullptr;
  lua_pushliteral(L, "__index");
  lua_rawget(L, -2);
  const void* identity = nullptr;
  if (lua_tocfunction(L, -1) == reader && lua_getupvalue(L, -1, upvalue) != nullptr) {
    identity = lua_touserdata(L, -1);
    lua_pop(L, 1);
  }
  lua_pop(L, 2);
  return identity;
}

const char kClosedMeta = 0;  // registry key, by address

int RefuseClosed(lua_State* L) {
  return luaL_error(L, "a closed object: Lua had let go of it already");
}

// The metatable of closed objects, made on first use.
void MakeClosedMetatable(lua_State* L) {
  if (lua_rawgetp(L, LUA_REGISTRYINDEX, &kClosedMeta) != LUA_TNIL) {
    lua_pop(L, 1);
    return;
  }
  lua_pop(L, 1);
  lua_createtable(L, 0, 6);
  for (const char* event : {"__index", "__newindex", "__call"}) {
    lua_pushcfunction(L, RefuseClosed);
    lua_setfield(L, -2, event);
  }
  lua_pushliteral(L, "closed object");
  lua_setfield(L, -2, "__name");
  lua_pushboolean(L, 0);
  lua_setfield(L, -2, "__metatable");
  lua_rawsetp(L, LUA_REGISTRYINDEX, &kClosedMeta);
}

void* Identity(const void* object) { return const_cast<void*>(object); }

}  // namespace

bool Schema::Has(const std::string& key) const {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

std::string UnknownKeyMessage(const std::string& what, const std::string& key,
                              const std::vector<std::string>& legal) {
  std::string message = what.empty() ? "" : what + ": ";
  message += "unknown key \"" + key + "\"";
  const std::string nearest = FindNearest(key, legal);
  if (!nearest.empty()) return message + FormatHint(nearest);
  std::string all;
  for (const std::string& name : legal) all += (all.empty() ? "" : ", ") + name;
  return message + " (the keys are " + all + ")";
}

void PushRecordTable(lua_State* L, const Schema& schema) {
  lua_createtable(L, 0, static_cast<int>(schema.keys.size()));
  if (lua_rawgetp(L, LUA_REGISTRYINDEX, &schema) == LUA_TNIL) {
    lua_pop(L, 1);
    lua_createtable(L, 0, 4);
    lua_pushlightuserdata(L, Identity(&schema));
    lua_pushcclosure(L, ReadMissingField, 1);
    lua_setfield(L, -2, "__index");
    lua_pushlightuserdata(L, Identity(&schema));
    lua_pushcclosure(L, RefuseNewField, 1);
    lua_setfield(L, -2, "__newindex");
    lua_pushstring(L, schema.name.c_str());
    lua_setfield(L, -2, "__name");
    lua_pushboolean(L, 0);
    lua_setfield(L, -2, "__metatable");
    if (schema.Has("text")) {
      lua_pushcfunction(L, RecordToText);
      lua_setfield(L, -2, "__tostring");
    }
    lua_pushvalue(L, -1);
    lua_rawsetp(L, LUA_REGISTRYINDEX, &schema);
  }
  lua_setmetatable(L, -2);
}

void PushFunction(lua_State* L, const FunctionInfo& function) {
  lua_pushlightuserdata(L, Identity(&function));
  lua_pushcclosure(L, function.call, 1);
}

void CloseObject(lua_State* L, int index) {
  index = lua_absindex(L, index);
  lua_rawgetp(L, LUA_REGISTRYINDEX, &kClosedMeta);
  lua_setmetatable(L, index);
}

void PushClassMetatable(lua_State* L, const ClassInfo& info, lua_CFunction destroy) {
  if (lua_rawgetp(L, LUA_REGISTRYINDEX, &info) != LUA_TNIL) return;
  lua_pop(L, 1);
  MakeClosedMetatable(L);
  lua_createtable(L, 0, 6);
  if (info.item != nullptr) {
    PushFunctions(L, info.properties);
    lua_pushcclosure(L, ObjectLength, 1);
    lua_setfield(L, -2, "__len");
  }
  PushFunctions(L, info.properties);
  lua_pushlightuserdata(L, Identity(&info));
  lua_pushcclosure(L, info.list ? ListPairs : ObjectPairs, 2);
  lua_setfield(L, -2, "__pairs");
  PushFunctions(L, info.methods);
  PushFunctions(L, info.properties);
  lua_pushlightuserdata(L, Identity(&info));
  lua_pushcclosure(L, ReadMember, 3);
  lua_setfield(L, -2, "__index");
  lua_pushlightuserdata(L, Identity(&info));
  lua_pushcclosure(L, RefuseMember, 1);
  lua_setfield(L, -2, "__newindex");
  lua_pushstring(L, info.name.c_str());
  lua_setfield(L, -2, "__name");
  lua_pushboolean(L, 0);
  lua_setfield(L, -2, "__metatable");
  lua_pushcfunction(L, destroy);
  lua_setfield(L, -2, "__gc");
  if (info.to_string != nullptr) {
    lua_pushcfunction(L, info.to_string);
    lua_setfield(L, -2, "__tostring");
  }
  lua_pushvalue(L, -1);
  lua_rawsetp(L, LUA_REGISTRYINDEX, &info);
}

const Schema* FindSchema(lua_State* L, int index) {
  return static_cast<const Schema*>(FindIdentity(L, index, ReadMissingField, 1));
}

const ClassInfo* FindClass(lua_State* L, int index) {
  return static_cast<const ClassInfo*>(FindIdentity(L, index, ReadMember, 3));
}

void* TestClass(lua_State* L, int index, const ClassInfo& info) {
  if (lua_type(L, index) != LUA_TUSERDATA || !lua_getmetatable(L, index)) return nullptr;
  lua_rawgetp(L, LUA_REGISTRYINDEX, &info);
  const bool same = lua_rawequal(L, -1, -2) != 0;
  lua_pop(L, 2);
  return same ? lua_touserdata(L, index) : nullptr;
}

}  // namespace pregrasp
