#include "bindings/scene_argument.h"

#include <algorithm>
#include <filesystem>

#include "app/core/data_folder.h"
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
    std::vector<std::string> stems;
    for (const fs::path& folder : {fs::path("scenes"), DataFolder() / "scenes"}) {
      std::error_code none;
      for (const auto& entry : fs::directory_iterator(folder, none)) {
        if (entry.path().extension() == ".lua") stems.push_back(entry.path().stem());
      }
    }
    std::sort(stems.begin(), stems.end());
    const std::string nearest = FindNearest(fs::path(name).stem().string(), stems);
    if (nearest.empty()) throw;
    throw InputError(error.where(), error.field(), error.expected(),
                     error.got() + FormatHint("scenes/" + nearest + ".lua"));
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
