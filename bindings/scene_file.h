#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/scene/scene.h"
#include "app/scene/settings.h"
#include "bindings/machine.h"

namespace pregrasp {

/// Of the Lua world that a scene's or ladder's file runs in: 2 s, 64 MB.
MachineConfig SceneFileLimits();

/// Runs a scene file in a Lua world of its own and returns its scene: settings
/// applied, validated, shapes loaded. Settings that are not the scene's stay in the list.
/// @throws InputError with file:line where there is one.
Scene LoadSceneFile(const std::filesystem::path& file, std::vector<Setting>& settings);

/// The last steps of that, also for a scene built in a script: finds the files that its shapes name
/// (the scene's folder first, then the working directory and the assets), validates and loads.
void FinishScene(Scene& scene, const std::filesystem::path& folder, std::vector<Setting>& settings);

/// The scene of the folders "scenes", the working directory's and the program's, whose name is
/// nearest to that of a file which is not there; empty for none.
std::filesystem::path FindNearestScene(const std::string& name);

/// Gives the scene the hand that it names; that of a file lies below the folder, or where files may
/// be read.
/// @param where  that names it, for messages.
/// @throws InputError.
void FindHandOf(Scene& scene, const std::filesystem::path& folder, const std::string& where);
/// What names the scene's hand once these settings are applied: the last that does, or its file.
std::string WhereHandIsNamed(const Scene& scene, const std::vector<Setting>& settings);

}  // namespace pregrasp
