#include "app/studies/holding_press.h"

#include <gtest/gtest.h>

namespace pregrasp {
namespace {

// A box, 4 cm wide and 10 cm high, on a table.
Scene BoxOnTable() {
  Scene scene;
  scene.name = "box";
  Body box;
  box.name = "box";
  box.shape = Box{{0.04, 0.04, 0.10}};
  box.X_WB.translation() = Vector3(0, 0, 0.05);
  box.friction = 0.4;
  box.mass_properties = MassProperties{
      0.2, Vector3::Zero(), Vector3(1.93e-4, 1.93e-4, 5.3e-5).asDiagonal().toDenseMatrix()};
  Body table;
  table.name = "table";
  table.shape = Box{{1, 1, 0.02}};
  table.X_WB.translation() = Vector3(0, 0, -0.01);
  scene.bodies = {box, table};
  return scene;
}

// The box tilted by `angle` about its lower edge at +x.
RigidTransform Tilted(double angle) {
  const Quaternion q(Eigen::AngleAxisd(angle, Vector3::UnitY()));
  const Vector3 edge_O(0.02, 0, -0.05);
  return MakeTransform(q, Vector3(0.02, 0, 0) - q * edge_O);
}

TEST(HoldingPressTest, WhatStaysByItselfHoldsWithoutAFinger) {
  const World world(BoxOnTable());
  ThreadPool pool(1);
  const HeldState held = FindHoldingPress(world, {Tilted(0), {}}, pool);
  EXPECT_TRUE(held.holds);
  EXPECT_LT(held.shift, 1e-4);
}

TEST(HoldingPressTest, WhatFallsIsHeldByTheRightFingerOnly) {
  const World world(BoxOnTable());
  ThreadPool pool(2);
  const RigidTransform X_WO = Tilted(0.25);  // falls back by itself: it tips over at 0.38
  EXPECT_FALSE(FindHoldingPress(world, {X_WO, {}}, pool).holds);
  // From above near the edge that it stands on: no push there holds it up.
  const LadderPose::Press useless{Finger::kIndex, Vector3(0.02, 0, -0.045)};
  EXPECT_FALSE(FindHoldingPress(world, {X_WO, useless}, pool).holds);
  // On the side that it would fall back to.
  const LadderPose::Press useful{Finger::kIndex, Vector3(-0.02, 0, 0.04)};
  const HeldState held = FindHoldingPress(world, {X_WO, useful}, pool);
  EXPECT_TRUE(held.holds);
  EXPECT_TRUE(held.state.fingers[static_cast<int>(Finger::kIndex)].touching);
}

TEST(HoldingPressTest, ThreadsDoNotMatter) {
  const World world(BoxOnTable());
  ThreadPool one(1), three(3);
  const LadderPose pose{Tilted(0.25), LadderPose::Press{Finger::kIndex, Vector3(-0.02, 0, 0.04)}};
  const HeldState a = FindHoldingPress(world, pose, one), b = FindHoldingPress(world, pose, three);
  EXPECT_EQ(a.shift, b.shift);
  EXPECT_EQ(a.state.bodies[0].p_WB, b.state.bodies[0].p_WB);
}

}  // namespace
}  // namespace pregrasp
