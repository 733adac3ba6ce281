// What a picture costs, in processor time of the whole process: Mesa draws on threads of its own.
#include <benchmark/benchmark.h>

#include "render/renderer.h"
#include "tests/render/sample_scenes.h"

namespace pregrasp {
namespace {

Renderer& SharedRenderer() {
  static Renderer renderer;
  return renderer;
}

void Picture(benchmark::State& state, RenderScene (*make_scene)(), const RenderConfig& config) {
  const RenderScene scene = make_scene();
  SharedRenderer().Render(scene, config);  // compiles shaders, uploads meshes
  for (auto _ : state) benchmark::DoNotOptimize(SharedRenderer().Render(scene, config));
}

constexpr RenderConfig kDraft{640, 360, RenderQuality::kDraft};
constexpr RenderConfig kNormal{1280, 720, RenderQuality::kNormal};
constexpr RenderConfig kStill{1280, 720, RenderQuality::kStill};

BENCHMARK_CAPTURE(Picture, draft_640x360_ruler, RulerScene, kDraft)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(Picture, draft_640x360_crowd, CrowdedScene, kDraft)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(Picture, normal_1280x720_shelf, ShelfScene, kNormal)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(Picture, still_1280x720_ruler, RulerScene, kStill)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(Picture, still_1280x720_shelf, ShelfScene, kStill)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(Picture, still_1280x720_plate, PlateScene, kStill)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(Picture, still_1280x720_crowd, CrowdedScene, kStill)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();

void PngEncoding(benchmark::State& state) {
  const Image image = SharedRenderer().Render(RulerScene(), kNormal);
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "render_bench.png";
  for (auto _ : state) WritePng(image, file);
  std::filesystem::remove(file);
}
BENCHMARK(PngEncoding)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pregrasp

BENCHMARK_MAIN();
