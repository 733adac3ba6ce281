// A program of others: reads a scene, and says what it holds.
#include <cstdio>
#include <vector>

#include "app/core/data_folder.h"
#include "app/hand/hand_model.h"
#include "bindings/scene_file.h"

int main() {
  using namespace pregrasp;
  std::vector<Setting> settings;
  const Scene scene = LoadSceneFile(DataFolder() / "scenes" / "ruler.lua", settings);
  std::printf("%s: %zu bodies, a hand of %zu links\n", scene.name.c_str(), scene.bodies.size(),
              ShadowHand().links.size());
}
