// Writes the sample pictures into a folder, for the eye: render_look FOLDER [QUALITY WIDTH HEIGHT].
#include <sys/resource.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>

#include "render/renderer.h"
#include "tests/render/sample_scenes.h"

int main(int argc, char** argv) {
  using namespace pregrasp;
  const std::filesystem::path folder = argc > 1 ? argv[1] : ".";
  RenderConfig config;
  config.quality = static_cast<RenderQuality>(argc > 2 ? std::atoi(argv[2]) : 2);
  if (argc > 4) {
    config.width = std::atoi(argv[3]);
    config.height = std::atoi(argv[4]);
  }
  std::filesystem::create_directories(folder);
  Renderer renderer;
  for (const auto& [name, scene] :
       {std::pair("ruler", RulerScene()), std::pair("shelf", ShelfScene()),
        std::pair("plate", PlateScene())}) {
    WritePng(renderer.Render(scene, config), folder / (std::string(name) + ".png"));
    rusage before{}, after{};
    getrusage(RUSAGE_SELF, &before);
    renderer.Render(scene, config);
    getrusage(RUSAGE_SELF, &after);
    const auto ms = [](const rusage& r) {
      return 1e3 * (r.ru_utime.tv_sec + r.ru_stime.tv_sec) +
             1e-3 * (r.ru_utime.tv_usec + r.ru_stime.tv_usec);
    };
    std::printf("%s %.0f ms CPU\n", name, ms(after) - ms(before));
  }
}
