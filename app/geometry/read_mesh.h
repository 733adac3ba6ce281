#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

#include "app/scene/shape.h"

namespace pregrasp {

/// Why a file gave no triangles or points: the two halves of an InputError, whose place the caller
/// knows.
struct UnreadableFile : std::runtime_error {
  UnreadableFile(const std::string& expected_text, const std::string& got_text)
      : std::runtime_error(expected_text), expected(expected_text), got(got_text) {}
  std::string expected;
  std::string got;  ///< follows the file's name: "which does not exist"
};

/// All triangles of a file as they are, in its own frame, whichever axis it says is up: PLY, OFF
/// and STL of text through our own readers, else through assimp in a process of its own
/// (ReadInChild), with the poses of the file's node tree and COLLADA's unit applied. At most 256 MB
/// and 2 million triangles.
/// @throws UnreadableFile
TriangleMesh ReadTriangles(const std::filesystem::path& file);

/// Points on a surface, as they are in a file.
struct PointFile {
  MatrixX3 P;
  MatrixX3 N;  ///< the points' normals; no rows where the file has none
};

/// The vertices of a PLY file, with or without faces. At most 256 MB and 2 million points.
/// @throws UnreadableFile
PointFile ReadPoints(const std::filesystem::path& file);

}  // namespace pregrasp
