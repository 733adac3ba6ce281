#include "app/grasp/lift.h"

#include <gtest/gtest.h>

#include "tests/grasp/grasp_scenes.h"

namespace pregrasp {
namespace {

// An upright carton that a hand can close on.
Scene CartonOnTable(double mass) {
  Scene scene = MakeScene("carton", Box{{0.05, 0.06, 0.12}}, mass, Shift(0, 0, 0.06));
  scene.bodies.push_back(FixedBox("table", {0.8, 0.8, 0.02}, {0, 0, -0.01}));
  return scene;
}

// Thumb against index and middle across the carton. Its forces must stay well below k r, stiffness
// times half the carton: springs of 50 N/m that are squeezed harder turn the object over.
GraspResult PinchGrasp(const GraspWorld& world) {
  const std::vector<GraspContact> contacts = {
      {Finger::kThumb, Vector3(0.0, -0.03, 0.03), -Vector3::UnitY()},
      {Finger::kIndex, Vector3(0.011, 0.03, 0.03), Vector3::UnitY()},
      {Finger::kMiddle, Vector3(-0.011, 0.03, 0.03), Vector3::UnitY()}};
  return TestContacts(world, GraspConfig(), contacts, world.StartPoses(), Rng(1, RngStream::kTest));
}

TEST(LiftTest, ACartonFollowsTheHand) {
  const Scene scene = CartonOnTable(0.06);
  const GraspWorld grasp_world(scene, ShadowHand());
  const World world(scene);
  const GraspResult grasp = PinchGrasp(grasp_world);
  ASSERT_TRUE(grasp.feasible());
  const LiftResult lift =
      SimulateLift(world, world.InitialState(), grasp_world, grasp, Vector3::UnitZ(), LiftConfig());
  EXPECT_TRUE(lift.held) << "shift " << lift.shift << " m, turn " << lift.turn_deg;
  EXPECT_NEAR(lift.height, 0.10, 0.01);
}

TEST(LiftTest, WithSlipperyFingersItStaysBehind) {
  const Scene scene = CartonOnTable(0.06);
  const GraspWorld grasp_world(scene, ShadowHand());
  const GraspResult grasp = PinchGrasp(grasp_world);
  ASSERT_TRUE(grasp.feasible());
  Scene slippery = scene;
  slippery.fingertips.friction = 0.02;
  const World world(slippery);
  const LiftResult lift =
      SimulateLift(world, world.InitialState(), grasp_world, grasp, Vector3::UnitZ(), LiftConfig());
  EXPECT_FALSE(lift.held);
}

TEST(LiftTest, TheDirectionIsUpWhereThatIsFreeAndOutwardsBelowABoard) {
  const PointCloud cloud =
      SamplePointCloud(Box{{0.05, 0.06, 0.12}}, 128, Rng(1, RngStream::kObjectCloud));
  const Scene open = CartonOnTable(0.2);
  const World open_world(open);
  EXPECT_TRUE(FindLiftDirection(open_world, open_world.InitialState(), cloud,
                                EnvironmentDistance(open), 0.1)
                  .isApprox(Vector3::UnitZ(), 1e-12));

  Scene covered = open;
  covered.bodies.push_back(FixedBox("board", {0.8, 0.8, 0.02}, {-0.3, 0, 0.14}));
  const World covered_world(covered);
  const Vector3 direction = FindLiftDirection(covered_world, covered_world.InitialState(), cloud,
                                              EnvironmentDistance(covered), 0.1);
  EXPECT_LT(direction.z(), 0.3);
}

}  // namespace
}  // namespace pregrasp
