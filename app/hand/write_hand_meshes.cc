// pregrasp-hand-meshes DIRECTORY: writes the hands' picture meshes as OBJ files, as they stand in
// assets/hands.
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "app/geometry/obj_text.h"
#include "app/hand/hand_meshes.h"

int main(int argc, char** argv) {
  using namespace pregrasp;
  if (argc != 2) {
    std::fputs("usage: pregrasp-hand-meshes DIRECTORY\n", stderr);
    return 2;
  }
  for (const auto& [hand, meshes] : {std::pair{"shadow_right", BuildShadowMeshes()},
                                     std::pair{"four_finger", BuildFourFingerMeshes()}}) {
    const std::filesystem::path folder = std::filesystem::path(argv[1]) / hand / "meshes";
    std::error_code ignored;
    std::filesystem::create_directories(folder, ignored);
    for (const auto& [name, mesh] : meshes) {
      std::ofstream out(folder / (name + ".obj"));
      out << FormatObj(mesh, 6);
      if (out) continue;
      std::fprintf(stderr, "%s: cannot write %s.obj\n", folder.c_str(), name.c_str());
      return 2;
    }
  }
  return 0;
}
