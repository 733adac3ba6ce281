#include "tests/render/golden.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "render/renderer.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

constexpr double kMostOutliers = 0.005;  // share of pixels that may differ by more than one level

fs::path GoldenFile(const std::string& name) {
  return fs::path(PREGRASP_SOURCE_DIR) / "tests/render/golden" / (name + ".png");
}

// Writes the picture, and the differences made visible, where a person can look at them.
fs::path WriteMismatch(const std::string& name, const Image& actual, const Image& golden) {
  const fs::path folder = fs::path(PREGRASP_PROGRAM).parent_path() / "golden";
  fs::create_directories(folder);
  WritePng(actual, folder / (name + "_actual.png"));
  Image diff = actual;
  for (std::size_t i = 0; i < diff.rgb.size(); ++i) {
    const int d = std::abs(actual.rgb[i] - golden.rgb[i]);
    diff.rgb[i] = static_cast<std::uint8_t>(d <= 1 ? 0 : std::min(255, 40 + 4 * d));
  }
  WritePng(diff, folder / (name + "_diff.png"));
  return folder;
}

}  // namespace

void ExpectGolden(const std::string& name, const RenderScene& scene, RenderQuality quality) {
  static Renderer renderer;
  const Image actual = renderer.Render(scene, {320, 180, quality});
  if (std::getenv("PREGRASP_UPDATE_GOLDEN") != nullptr) {
    WritePng(actual, GoldenFile(name));
    GTEST_SKIP() << "wrote " << GoldenFile(name);
  }
  const Image golden = ReadPng(GoldenFile(name));
  ASSERT_EQ(golden.rgb.size(), actual.rgb.size());
  int outliers = 0;
  for (std::size_t i = 0; i < actual.rgb.size(); i += 3) {
    int most = 0;
    for (std::size_t c = i; c < i + 3; ++c) {
      most = std::max(most, std::abs(actual.rgb[c] - golden.rgb[c]));
    }
    outliers += most > 1 ? 1 : 0;
  }
  const double share = outliers / (320.0 * 180.0);
  if (share > kMostOutliers) {
    ADD_FAILURE() << 100 * share << " % of the pixels differ; see "
                  << WriteMismatch(name, actual, golden);
  }
}

}  // namespace pregrasp
