#pragma once

#include <string>

namespace pregrasp {

struct MeshCheck {
  std::string file;
  double scale = 1.0;
  bool repair = false;
  std::string picture;  ///< FILE.png, empty for none
};

/// Whether `file` names a mesh rather than a scene.
bool IsMeshFile(const std::string& file);

/// Prints what a mesh file holds, as a scene's mesh{..} would take it, and draws it with its open
/// edges in red. @return the exit code. @throws InputError as loading it would, after the picture.
int CheckMesh(const MeshCheck& check);

}  // namespace pregrasp
