#pragma once

#include <string>
#include <string_view>

#include "app/scene/shape.h"

namespace pregrasp {

/// What a PLY file holds of a surface or a cloud.
struct PlyContent {
  MatrixX3 V;
  MatrixX3 N;   ///< the vertices' normals as they are in the file; no rows where it has none
  MatrixX3i F;  ///< polygons triangulated; no rows for a cloud
};

/// Reads PLY 1.0 (ASCII, binary little- and big-endian): the elements "vertex" and "face"; others
/// are skipped. assimp reads PLY too, but does not come back from a file that ends early, and needs
/// faces.
/// @throws std::runtime_error saying what is wrong ("ends within element \"vertex\"").
PlyContent ParsePly(std::string_view bytes);

}  // namespace pregrasp
