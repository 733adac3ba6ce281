#include "render/label_layout.h"

#include <gtest/gtest.h>

#include "app/core/rng.h"

namespace pregrasp {
namespace {

struct Case {
  std::vector<LabelRequest> requests;
  LabelArea area;
};

Case RandomCase(Rng& rng) {
  Case c;
  const double width = rng.Uniform(200, 1300), height = rng.Uniform(120, 750);
  c.area.picture = {0, 0, width, height};
  c.area.scale = rng.Uniform(0.66, 1.5);
  if (rng.Uniform() < 0.7) c.area.obstacles.push_back({20, 20, 0.4 * width, 0.3 * height});
  if (rng.Uniform() < 0.7) c.area.obstacles.push_back({0, height - 30, width, 30});
  for (int i = 0; i < 3; ++i) {
    const Vector2 a(rng.Uniform(0, width), rng.Uniform(0, height));
    c.area.shapes.push_back({a, a + Vector2(60, 10), a + Vector2(30, 50)});
  }
  const int count = static_cast<int>(rng.UniformInt(40));
  // Half the time all anchors lie close together, as contacts do.
  const bool crowd = rng.Uniform() < 0.5;
  const Vector2 middle(rng.Uniform(0, width), rng.Uniform(0, height));
  for (int i = 0; i < count; ++i) {
    Vector2 anchor(rng.Uniform(0, width), rng.Uniform(0, height));
    if (crowd) anchor = middle + 0.05 * (anchor - middle);
    c.requests.push_back({anchor, {rng.Uniform(30, 180), rng.Uniform(16, 30)}});
  }
  return c;
}

TEST(LabelLayoutTest, WhatIsHiddenIsTheSumOfEachThingsShare) {
  const Rect rect{10, 20, 240, 160};
  const std::vector<Vector2> left = {{-50, 0}, {130, 0}, {130, 300}, {-50, 300}},
                             corner = {{10, 20}, {250, 20}, {10, 180}},
                             away = {{300, 0}, {400, 0}, {350, 50}};
  EXPECT_EQ(CalcHiddenShares(rect, {}), 0.0);
  EXPECT_EQ(CalcHiddenShares(rect, {away}), 0.0);
  EXPECT_NEAR(CalcHiddenShares(rect, {left}), 120.0 / 180.0 * 160.0 / 300.0, 0.05);
  EXPECT_DOUBLE_EQ(CalcHiddenShares(rect, {corner}), 1.0);            // small, and wholly behind it
  const std::vector<Vector2> turned(corner.rbegin(), corner.rend());  // the other way round
  EXPECT_DOUBLE_EQ(CalcHiddenShares(rect, {turned}), 1.0);
  EXPECT_DOUBLE_EQ(CalcHiddenShares(rect, {corner, turned, away}), 2.0);
}

TEST(LabelLayoutTest, BoxesNeverOverlapEachOtherObstaclesOrAnchorsAndStayInside) {
  Rng rng(1);
  int placed = 0, asked = 0;
  for (int seed = 0; seed < 150; ++seed) {
    const Case c = RandomCase(rng);
    const auto boxes = LayOutLabels(c.requests, c.area);
    ASSERT_EQ(boxes.size(), c.requests.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      ++asked;
      if (!boxes[i]) continue;
      ++placed;
      const Rect& box = *boxes[i];
      EXPECT_DOUBLE_EQ(box.width, c.requests[i].size.x());
      EXPECT_DOUBLE_EQ(box.height, c.requests[i].size.y());
      EXPECT_GE(box.x, c.area.picture.x);
      EXPECT_GE(box.y, c.area.picture.y);
      EXPECT_LE(box.right(), c.area.picture.right());
      EXPECT_LE(box.bottom(), c.area.picture.bottom());
      for (const Rect& obstacle : c.area.obstacles) EXPECT_FALSE(box.Overlaps(obstacle)) << seed;
      for (std::size_t j = 0; j < boxes.size(); ++j) {
        EXPECT_FALSE(box.Contains(c.requests[j].anchor)) << seed;
        if (j != i && boxes[j]) {
          EXPECT_FALSE(box.Overlaps(*boxes[j])) << seed;
        }
      }
    }
  }
  // The claim above would hold for a layout that places nothing.
  EXPECT_GT(placed, 0.85 * asked);
  EXPECT_GT(asked, 1500);
}

TEST(LabelLayoutTest, ALoneLabelLiesCloseToItsAnchor) {
  LabelArea area;
  area.picture = {0, 0, 640, 360};
  for (const Vector2& anchor : {Vector2(320, 180), Vector2(5, 5), Vector2(635, 355)}) {
    const auto box = LayOutLabels({{anchor, {80, 20}}}, area)[0];
    ASSERT_TRUE(box.has_value());
    EXPECT_LT((LeaderStart(*box, anchor) - anchor).norm(), 45.0);
  }
}

TEST(LabelLayoutTest, FiveFingertipsInARowKeepTheirLeadersApart) {
  LabelArea area;
  area.picture = {0, 0, 1280, 720};
  std::vector<LabelRequest> requests;
  for (int i = 0; i < 5; ++i) requests.push_back({{560 + 22.0 * i, 290 + 3.0 * i}, {110, 25}});
  const auto boxes = LayOutLabels(requests, area);
  const auto cross = [](const Vector2& u, const Vector2& v) {
    return u.x() * v.y() - u.y() * v.x();
  };
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    ASSERT_TRUE(boxes[i].has_value());
    for (std::size_t j = 0; j < i; ++j) {
      const Vector2 a = LeaderStart(*boxes[i], requests[i].anchor), b = requests[i].anchor;
      const Vector2 c = LeaderStart(*boxes[j], requests[j].anchor), d = requests[j].anchor;
      EXPECT_FALSE(cross(b - a, c - a) * cross(b - a, d - a) < 0 &&
                   cross(d - c, a - c) * cross(d - c, b - c) < 0)
          << i << " crosses " << j;
    }
  }
}

TEST(LabelLayoutTest, AShapeIsLeftUncoveredWhereThereIsRoom) {
  LabelArea area;
  area.picture = {0, 0, 640, 360};
  area.shapes = {{{300, 150}, {420, 150}, {420, 260}, {300, 260}}};
  const auto box = LayOutLabels({{{330, 170}, {80, 20}}}, area)[0];
  ASSERT_TRUE(box.has_value());
  EXPECT_FALSE(box->Overlaps({300, 150, 120, 110}));
}

TEST(LabelLayoutTest, ALabelWithoutRoomGetsNoPlace) {
  LabelArea area;
  area.picture = {0, 0, 60, 60};
  EXPECT_FALSE(LayOutLabels({{{30, 30}, {80, 20}}}, area)[0].has_value());
}

}  // namespace
}  // namespace pregrasp
