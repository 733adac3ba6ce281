// pregrasp-hand-meshes DIRECTORY: writes the hand's picture meshes as OBJ files, as they stand in
// assets/hand/meshes.
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "app/geometry/obj_text.h"
#include "app/hand/hand_meshes.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: pregrasp-hand-meshes DIRECTORY\n", stderr);
    return 2;
  }
  for (const auto& [name, mesh] : pregrasp::BuildHandMeshes()) {
    std::ofstream out(std::filesystem::path(argv[1]) / (name + ".obj"));
    out << pregrasp::FormatObj(mesh, 6);
    if (!out) {
      std::fprintf(stderr, "%s: cannot write %s.obj\n", argv[1], name.c_str());
      return 2;
    }
  }
  return 0;
}
