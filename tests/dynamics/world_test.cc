#include "app/dynamics/world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/core/error.h"
#include "tests/dynamics/scenes.h"

namespace pregrasp {
namespace {

TEST(WorldTest, ABoxAtRestDriftsLessThanAMicrometreInFiveSeconds) {
  for (const double yaw : {0.0, 10.0, 45.0}) {
    const World world(MakeScene(MakeBox("box", Vector3(0.1, 0.08, 0.06),
                                        At(0.1, 0.2, 0.03, Vector3(0, 0, yaw)), 0.3, 0.5)));
    WorldState state = world.InitialState();
    const BodyState start = state.bodies[0];
    Simulate(world, 5.0, &state);
    EXPECT_LT((state.bodies[0].p_WB - start.p_WB).norm(), 1e-6) << "yaw " << yaw;
    EXPECT_LT(state.bodies[0].q_WB.angularDistance(start.q_WB), 1e-5) << "yaw " << yaw;
  }
}

TEST(WorldTest, ABoxSticksBelowTheFrictionAngleAndSlipsAboveIt) {
  // mu = 0.5: the angle is atan 0.5 = 26.565 degrees.
  for (const double degrees : {20.0, 26.0}) {
    Scene scene = MakeScene(MakeBox("box", Vector3(0.1, 0.08, 0.02), At(0, 0, 0.01), 0.3, 0.5));
    scene.gravity = InclineGravity(DegToRad(degrees));
    const World world(scene);
    WorldState state = world.InitialState();
    Simulate(world, 1.0, &state);
    const Vector3 start = state.bodies[0].p_WB;
    Simulate(world, 2.0, &state);
    EXPECT_LT((state.bodies[0].p_WB - start).norm() / 2.0, 1e-5) << degrees;
  }
  Scene scene = MakeScene(MakeBox("box", Vector3(0.1, 0.08, 0.02), At(0, 0, 0.01), 0.3, 0.5));
  scene.gravity = InclineGravity(DegToRad(27.0));
  const World world(scene);
  WorldState state = world.InitialState();
  Simulate(world, 0.25, &state);
  const double start = state.bodies[0].v_WB.x();
  Simulate(world, 1.0, &state);
  const double a = 9.81 * (std::sin(DegToRad(27.0)) - 0.5 * std::cos(DegToRad(27.0)));
  EXPECT_NEAR(state.bodies[0].v_WB.x() - start, a * 1.0, 1e-4 * a);
}

TEST(WorldTest, ASlidingBoxCoversTheClosedFormDistance) {
  // Semi-implicit Euler covers a t (t + h) / 2 exactly where the law is a t^2 / 2.
  const double angle = DegToRad(30.0), mu = 0.3;
  Scene scene = MakeScene(MakeBox("box", Vector3(0.1, 0.08, 0.02), At(0, 0, 0.01), 0.3, mu));
  scene.gravity = InclineGravity(angle);
  const World world(scene);
  WorldState state = world.InitialState();
  Simulate(world, 0.5, &state);
  const double a = 9.81 * (std::sin(angle) - mu * std::cos(angle));
  EXPECT_NEAR(state.bodies[0].p_WB.x(), 0.5 * a * 0.5 * (0.5 + world.config().dt), 1e-6);
}

TEST(WorldTest, FreeTumblingKeepsAngularMomentumAndNearlyItsEnergy) {
  Scene scene = MakeScene(MakeBox("box", Vector3(0.1, 0.08, 0.03), At(0, 0, 2.0), 0.3, 0.5));
  scene.gravity.setZero();
  const World world(scene);
  WorldState state = world.InitialState();
  state.bodies[0].w_WB = Vector3(0.1, 8.0, 0.2);
  const auto momentum = [&] {
    const Matrix3 R = state.bodies[0].q_WB.toRotationMatrix();
    return Vector3(R * scene.object().mass_properties->I_BBcm * R.transpose() *
                   state.bodies[0].w_WB);
  };
  const Vector3 L = momentum();
  const double energy = world.CalcEnergy(state);
  Simulate(world, 2.0, &state);
  EXPECT_LT((momentum() - L).norm(), 1e-12 * L.norm());
  EXPECT_NEAR(world.CalcEnergy(state), energy, 1e-3 * energy);
}

TEST(WorldTest, BadSettingsAreRefused) {
  const Scene scene = MakeScene(MakeBox("box", Vector3(0.1, 0.1, 0.1), At(0, 0, 0.05), 0.5, 0.5));
  StepConfig config;
  config.dt = 0.0;
  EXPECT_THROW(World(scene, config), InputError);
  config = {};
  config.max_sweeps = 0;
  EXPECT_THROW(World(scene, config), InputError);
}

TEST(WorldTest, AnInertiaNoBodyCanHaveIsRefused) {
  Scene scene = MakeScene(MakeBox("box", Vector3(0.1, 0.1, 0.1), At(0, 0, 0.05), 0.5, 0.5));
  scene.object().mass_properties->I_BBcm = Vector3(1e-3, 1e-5, 1e-5).asDiagonal();
  EXPECT_THROW(World{scene}, InputError);
}

}  // namespace
}  // namespace pregrasp
