#pragma once

#include <string>
#include <vector>

#include "app/scene/scene.h"

namespace pregrasp {

/// `key.path=value` of the command line's --set, or of a script's `set` table: changes one value of
/// the scene or of a stage's configuration without editing a file.
struct Setting {
  std::string key;              ///< "fingertips.friction", "environment.left.mass"
  std::string value;            ///< as written: a number, {x, y, z} as "0,0,0.1", a name
  std::string where = "--set";  ///< what messages about it begin with: as its user typed it
};

/// @throws InputError("--set") without a key or a value.
Setting ParseSetting(const std::string& assignment);

/// Applies those that name a part of the scene, and takes them out of the list: name; hand;
/// object.{name,mass,friction,p,rpy_deg}; environment.NAME.{the same}; fingertips.{friction,
/// max_force,stiffness,damping,grasp_stiffness}; gravity; camera.{p,look_at,fov_deg}. To be called
/// before the scene's shapes are loaded, so that a new mass also means a new inertia.
/// @throws InputError for an unknown key, with the nearest legal one, or a value that does not fit,
/// by itself or with the rest of the scene.
void ApplySceneSettings(Scene& scene, std::vector<Setting>& settings);

/// @throws InputError about the first setting, which nobody took; `known` are the other legal
/// roots.
void RequireNoSettingsLeft(const std::vector<Setting>& settings,
                           const std::vector<std::string>& known = {});

}  // namespace pregrasp
