#include "app/dynamics/neighbours.h"

#include <gtest/gtest.h>

#include "app/dynamics/tip_overlap.h"
#include "tests/dynamics/scenes.h"

namespace pregrasp {
namespace {

Scene MakeRow() {
  return MakeScene(
      MakeBox("box", Vector3(0.1, 0.08, 0.06), At(0, 0, 0.03), 0.4, 0.4),
      {MakeTable(), MakeBox("left", Vector3(0.05, 0.1, 0.12), At(0.3, 0, 0.06), 0.6, 0.3),
       MakeBox("right", Vector3(0.05, 0.1, 0.12), At(-0.3, 0, 0.06), 0.6, 0.3)});
}

TEST(NeighbourTest, AtTheStartNoneHasMoved) {
  const World world(MakeRow());
  const NeighbourMotion motion = CalcNeighbourMotion(world, world.InitialState());
  EXPECT_EQ(motion.moved, 0.0);
  EXPECT_NEAR(motion.turned_deg, 0.0, 1e-6);
  EXPECT_FALSE(motion.disturbed);
}

TEST(NeighbourTest, OneTurnedOverBy30DegreesOr5CmBelowItsStartIsDisturbed) {
  const World world(MakeRow());
  const auto after = [&](double degrees, const Vector3& shift) {
    WorldState state = world.InitialState();
    state.bodies[2].q_WB = Quaternion(Eigen::AngleAxisd(DegToRad(degrees), Vector3::UnitX()));
    state.bodies[2].p_WB += shift;
    state.bodies[1].p_WB.x() += 0.001;
    return CalcNeighbourMotion(world, state);
  };
  EXPECT_FALSE(after(29.0, Vector3::Zero()).disturbed);
  EXPECT_TRUE(after(31.0, Vector3::Zero()).disturbed);
  EXPECT_FALSE(after(0.0, Vector3(0, 0, -0.049)).disturbed);
  EXPECT_TRUE(after(0.0, Vector3(0, 0, -0.051)).disturbed);
  EXPECT_FALSE(after(0.0, Vector3(0.3, 0, 0.06)).disturbed);  // aside and up
  EXPECT_TRUE(after(std::numeric_limits<double>::quiet_NaN(), Vector3::Zero()).disturbed);
  const NeighbourMotion motion = after(20.0, Vector3(0.03, 0, -0.04));
  EXPECT_EQ(motion.worst, BodyIndex{3});
  EXPECT_NEAR(motion.moved, 0.05, 1e-9);
  EXPECT_NEAR(motion.turned_deg, 20.0, 1e-6);
  EXPECT_NEAR(motion.fell, 0.04, 1e-9);
}

TEST(NeighbourTest, TheObjectIsNoneOfThem) {
  const World world(
      MakeScene(MakeBox("box", Vector3(0.1, 0.08, 0.06), At(0, 0, 0.03), 0.4, 0.4), {MakeTable()}));
  WorldState state = world.InitialState();
  state.bodies[0].p_WB.z() -= 1.0;
  const NeighbourMotion motion = CalcNeighbourMotion(world, state);
  EXPECT_FALSE(motion.worst.has_value());
  EXPECT_FALSE(motion.disturbed);
}

TEST(TipOverlapTest, IsHowDeepTheSphereOutsideTheObjectReachesIntoTheSurroundings) {
  // A side contact z above the table: the sphere's centre is at the same height.
  const Scene scene =
      MakeScene(MakeBox("box", Vector3(0.1, 0.08, 0.06), At(0, 0, 0.03), 0.4, 0.4), {MakeTable()});
  const World world(scene);
  const EnvironmentDistance environment(scene);
  for (const double z : {0.004, 0.0087, 0.02}) {
    WorldState state = world.InitialState();
    world.PutFinger(state, Finger::kIndex, Vector3(0.05, 0.0, z - 0.03));
    EXPECT_NEAR(CalcTipOverlap(state, Finger::kIndex, 0.009, world.GetPoses(state), environment),
                0.0090 - z, 1e-9);
  }
}

}  // namespace
}  // namespace pregrasp
