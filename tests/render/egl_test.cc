// The stored pictures through EGL, whatever the program draws with: gl_egl.cc is linked into this
// test in place of the library's backend.
#include <gtest/gtest.h>

#include <string>

#include "tests/render/golden.h"
#include "tests/render/sample_scenes.h"

namespace pregrasp {
namespace {

TEST(EglTest, GivesTheSameStill) {
  ExpectGolden("ruler_still", RulerScene(), RenderQuality::kStill);
  ExpectGolden("shelf_still", ShelfScene(), RenderQuality::kStill);
}

TEST(EglTest, GivesTheSameDraftAndNormalPicture) {
  ExpectGolden("ruler_draft", RulerScene(), RenderQuality::kDraft);
  ExpectGolden("plate_normal", PlateScene(), RenderQuality::kNormal);
}

TEST(EglTest, DrawsOnTheProcessorAndContextsComeAndGo) {
  const RenderConfig config{160, 90, RenderQuality::kDraft};
  const Image first = Renderer().Render(RulerScene(), config);
  for (int i = 0; i < 3; ++i) {
    Renderer renderer;
    EXPECT_EQ(renderer.Render(RulerScene(), config).rgb, first.rgb);
    const std::string description = renderer.description();
    EXPECT_NE(description.find("llvmpipe"), std::string::npos) << description;
    EXPECT_NE(description.find(" through EGL"), std::string::npos) << description;
  }
}

}  // namespace
}  // namespace pregrasp
