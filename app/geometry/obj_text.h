#pragma once

#include <optional>
#include <string>

#include "app/scene/shape.h"

namespace pregrasp {

/// A mesh as Wavefront OBJ: "v x y z" [m] and "f i j k" (from 1), in order. A point cloud is a mesh
/// without faces.
/// @param decimals  of a coordinate; without, numbers read back exactly.
std::string FormatObj(const TriangleMesh& mesh, std::optional<int> decimals = std::nullopt);

/// Reads what FormatObj writes: v and f lines of triangles, comments and empty lines.
/// @param where  names the file in messages.
/// @throws InputError with file:line for anything else.
TriangleMesh ParseObj(const std::string& text, const std::string& where);

}  // namespace pregrasp
