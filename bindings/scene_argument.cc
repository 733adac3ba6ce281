#include "bindings/scene_argument.h"

#include <filesystem>

#include "app/core/text.h"
#include "bindings/lua_scene.h"
#include "bindings/machine.h"
#include "bindings/scene_file.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

// A scene's file. Where there is none of that name, the error names the nearest of the folders
// "scenes".
fs::path FindScene(Machine& machine, const std::string& name) {
  try {
    return machine.files().FindForReading(name);
  } catch (const InputError& error) {
    if (error.got() != "nothing of that name") throw;
    const fs::path nearest = FindNearestScene(name);
    if (nearest.empty()) throw;
    // By this name it may be read wherever the program runs.
    throw InputError(error.where(), error.field(), error.expected(),
                     error.got() + FormatHint("scenes/" + nearest.filename().string()));
  }
}

}  // namespace

SceneArgument LuaValue<SceneArgument>::Read(lua_State* L, int index, const std::string& path) {
  if (lua_type(L, index) == LUA_TSTRING) {
    return {LuaValue<std::string>::Read(L, index, path), {}};
  }
  if (!lua_istable(L, index) && !IsScene(L, index)) {
    throw InputError("", path, "a scene file's name or a scene", DescribeValue(L, index));
  }
  return {std::nullopt, ReadScene(L, index)};
}

Scene LoadScene(lua_State* L, SceneArgument argument, std::vector<Setting>& settings) {
  Machine& machine = Machine::Of(L);
  if (argument.file) return LoadSceneFile(FindScene(machine, *argument.file), settings);
  FinishScene(argument.scene, machine.script_folder(), settings);
  return std::move(argument.scene);
}

}  // namespace pregrasp
