#pragma once

#include <filesystem>

#include "app/scene/shape.h"

namespace pregrasp {

/// Writes a mesh as Wavefront OBJ: "v x y z" [m] and "f i j k" (from 1), in order and with numbers
/// that read back exactly. A point cloud is a mesh without faces. @throws InputError as
/// CheckedFile.
void WriteObj(const std::filesystem::path& file, const TriangleMesh& mesh);

/// Reads what WriteObj writes: v and f lines of triangles, comments and empty lines.
/// @throws InputError with file:line for anything else.
TriangleMesh ReadObj(const std::filesystem::path& file);

}  // namespace pregrasp
