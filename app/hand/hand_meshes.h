#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/scene/shape.h"

namespace pregrasp {

// The picture meshes of assets/hands/NAME/meshes by name, each in its link's frame: made here from
// a few lofted sections and turned profiles, close to the collision capsules. The committed files
// are what these return; pregrasp-hand-meshes writes them.
std::vector<std::pair<std::string, TriangleMesh>> BuildShadowMeshes();
std::vector<std::pair<std::string, TriangleMesh>> BuildFourFingerMeshes();

}  // namespace pregrasp
