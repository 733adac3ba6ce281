#pragma once

#include <filesystem>

#include "app/scene/scene.h"

namespace pregrasp {

/// Writes scene.json and meshes/ into `directory`: the resolved scene, enough to rebuild the world
/// in another simulator. The schema is in app/recording/README.md.
/// @param scene  validated and loaded.  @param dt  the simulation's step [s].
/// @throws InputError as CheckedFile.
void WriteScene(const std::filesystem::path& directory, const Scene& scene, double dt);

/// The scene that WriteScene wrote, to the last bit; only `Scene::file` and `Body::where` differ,
/// which say where it was read from.
/// @param file  scene.json; meshes are found relative to its folder.
/// @throws InputError for a file that is missing or not of that schema, or an invalid scene.
Scene LoadScene(const std::filesystem::path& file);

}  // namespace pregrasp
