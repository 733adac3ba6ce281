#pragma once

#include <string>
#include <vector>

#include "app/core/lua_api.h"
#include "app/scene/scene.h"
#include "bindings/value.h"

namespace pregrasp {

/// A shape as the constructors give it: a value that cannot be changed, with the line that made it.
struct LuaShape {
  Shape shape;
  std::string where;
  int parts = 1;  ///< of a union, all levels
  int depth = 1;
};

/// What every constructor of a scene or ladder file takes: one table, at index 1 of the stack.
struct OneTable {
  lua_State* L = nullptr;
};
template <>
struct LuaValue<OneTable> {
  static OneTable Read(lua_State* L, int index, const std::string& path);
};

/// scene, box, cylinder, capsule, sphere, mesh, cloud and union, for a module or as globals.
const std::vector<FunctionInfo>& SceneConstructors();

/// The tables that the constructors take, for lua/meta.
std::vector<const Schema*> SceneSchemas();
std::vector<const ClassInfo*> SceneClasses();

/// Whether the value is what scene{..} gave.
bool IsScene(lua_State* L, int index);

/// What scene{..} gave, or the plain table that it takes, as a scene; not validated.
/// @throws InputError with the file:line of the shape that the field belongs to.
Scene ReadScene(lua_State* L, int index);

/// The table {p = .., look_at = .., fov_deg = ..} under `key` of another.
CameraConfig ReadCamera(lua_State* L, const Fields& owner, const std::string& key);

/// The keys p and rpy_deg, both optional, as a pose. @throws InputError.
RigidTransform ReadPose(const Fields& fields);

/// From now on the constructor `scene` of this state may be called once.
void AllowOneScene(lua_State* L);

}  // namespace pregrasp
