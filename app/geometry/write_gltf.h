#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/core/math.h"
#include "app/scene/shape.h"

namespace pregrasp {

/// A mesh that moves through an animation.
struct AnimatedMesh {
  std::string name;
  std::shared_ptr<const TriangleMesh> mesh;
  std::array<float, 4> rgba{0.8F, 0.8F, 0.8F, 1.0F};  ///< linear
  std::vector<RigidTransform> X_WB;                   ///< one a moment; a single one if it stands
};

/// Writes an animation as binary glTF 2.0, for modelling programs and web viewers: a node a mesh,
/// under one that turns our z up into theirs (y). The same input gives the same bytes.
/// @param times  ascending [s]; those of every mesh that moves.
/// @throws InputError if the file cannot be written.
void WriteGltf(const std::filesystem::path& file, const std::vector<AnimatedMesh>& meshes,
               const std::vector<double>& times);

}  // namespace pregrasp
