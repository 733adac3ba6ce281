#pragma once

#include <filesystem>

#include "app/scene/scene.h"

namespace pregrasp {

/// Reads the files that a scene's Mesh and Cloud shapes name, relative to `directory`, through
/// assimp; checks that a mesh is closed, two-manifold and of positive volume (orienting it
/// outward), and reconstructs a closed mesh from a cloud. Fills in a movable body's centre of mass
/// and inertia, uniform density, where the scene gave none.
/// @throws InputError naming the body's file:line: missing file, unknown format, open mesh, NaN,
/// too few points.
void LoadShapes(Scene& scene, const std::filesystem::path& directory);

}  // namespace pregrasp
