#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/scene/scene.h"
#include "app/scene/settings.h"
#include "bindings/value.h"

namespace pregrasp {

/// A scene as scripts give it: the name of a file, what scene{..} gave, or its table.
struct SceneArgument {
  std::optional<std::string> file;
  Scene scene;  ///< without a file
};
template <>
struct LuaValue<SceneArgument> {
  static SceneArgument Read(lua_State* L, int index, const std::string& path);
};

/// The scene: settings applied, validated, shapes loaded. Settings that are not the scene's stay in
/// the list.
/// @throws InputError; for a file that is not there with the nearest one of the folders "scenes".
Scene LoadScene(lua_State* L, SceneArgument argument, std::vector<Setting>& settings);

}  // namespace pregrasp
