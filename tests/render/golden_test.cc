// Pictures against stored ones, by what the program draws with.
#include <gtest/gtest.h>

#include "tests/render/golden.h"
#include "tests/render/sample_scenes.h"

namespace pregrasp {
namespace {

TEST(GoldenTest, RulerStill) { ExpectGolden("ruler_still", RulerScene(), RenderQuality::kStill); }
TEST(GoldenTest, RulerDraft) { ExpectGolden("ruler_draft", RulerScene(), RenderQuality::kDraft); }
TEST(GoldenTest, ShelfStill) { ExpectGolden("shelf_still", ShelfScene(), RenderQuality::kStill); }
TEST(GoldenTest, PlateNormal) {
  ExpectGolden("plate_normal", PlateScene(), RenderQuality::kNormal);
}

}  // namespace
}  // namespace pregrasp
