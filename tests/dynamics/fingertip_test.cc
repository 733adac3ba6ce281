// The fingertip's law: spring, damper, friction cone, force cap, lift-off.
#include <gtest/gtest.h>

#include <cmath>

#include "app/core/error.h"
#include "app/dynamics/world.h"
#include "tests/dynamics/scenes.h"

namespace pregrasp {
namespace {

// A cube that walls hold on all sides, so that the finger's law is seen alone.
Scene MakeHeldCube() {
  return MakeScene(MakeBox("cube", Vector3(0.1, 0.1, 0.1), At(0, 0, 0.05), 0.5, 0.5),
                   {MakeTable(), MakeFixed("left", Box{Vector3(0.1, 1, 1)}, At(-0.1, 0, 0.5), 0.5),
                    MakeFixed("right", Box{Vector3(0.1, 1, 1)}, At(0.1, 0, 0.5), 0.5),
                    MakeFixed("front", Box{Vector3(1, 0.1, 1)}, At(0, -0.1, 0.5), 0.5),
                    MakeFixed("back", Box{Vector3(1, 0.1, 1)}, At(0, 0.1, 0.5), 0.5)});
}

TEST(FingertipTest, AStickingFingerPushesWithStiffnessTimesOffset) {
  const World world(MakeHeldCube());
  WorldState state = world.InitialState();
  world.PutFinger(state, Finger::kIndex, Vector3(0.01, 0.02, 0.05));
  const Vector3 offset(0.02, 0.01, -0.05);
  state.fingers[kIndex].p_WTarget += offset;
  Simulate(world, 0.5, &state);
  const FingertipState& finger = state.fingers[kIndex];
  EXPECT_LT((finger.f_W - 50.0 * offset).norm(), 1e-4);
  EXPECT_TRUE(finger.touching);
  EXPECT_FALSE(finger.slipping);
  EXPECT_EQ(finger.slip, 0.0);
  EXPECT_EQ(finger.p_OC, Vector3(0.01, 0.02, 0.05));
}

TEST(FingertipTest, ASlippingFingerObeysCoulombExactlyAndComesToRestAtTheConesEdge) {
  const World world(MakeHeldCube());
  WorldState state = world.InitialState();
  world.PutFinger(state, Finger::kIndex, Vector3(0.0, 0.0, 0.05));
  FingertipState& finger = state.fingers[kIndex];
  finger.p_WTarget += Vector3(0.03, 0.01, -0.02);
  bool slipped = false;
  for (int i = 0; i < 240; ++i) {
    const Vector3 nhat_W = state.bodies[0].q_WB * finger.nhat_O;
    world.Step(state);
    const double normal = -nhat_W.dot(finger.f_W);
    const double tangential = (finger.f_W + normal * nhat_W).norm();
    ASSERT_LE(tangential, 0.8 * normal * (1.0 + 1e-9));
    if (!finger.slipping) continue;
    slipped = true;
    ASSERT_NEAR(tangential, 0.8 * normal, 1e-12);
    ASSERT_NEAR(finger.p_OC.z(), 0.05, 1e-9);
    // Friction drives the object along the slip.
    ASSERT_NEAR(finger.f_W.x() * 0.01 - finger.f_W.y() * 0.03, 0.0, 1e-5);
  }
  EXPECT_TRUE(slipped);
  // At rest k |offset - slip| = mu k 0.02 along the surface.
  EXPECT_NEAR(finger.slip, std::hypot(0.03, 0.01) - 0.8 * 0.02, 1e-4);
}

TEST(FingertipTest, TheCapBoundsTheForceAndKeepsItsDirection) {
  const World world(MakeHeldCube());
  WorldState state = world.InitialState();
  world.PutFinger(state, Finger::kIndex, Vector3(0.0, 0.0, 0.05));
  FingertipState& finger = state.fingers[kIndex];
  const Vector3 offset(0.1, -0.05, -0.4);
  finger.p_WTarget += offset;
  Simulate(world, 0.5, &state);
  EXPECT_NEAR(finger.f_W.norm(), 12.0, 1e-9);
  EXPECT_LT((finger.f_W / 12.0 - offset.normalized()).norm(), 1e-4);
  EXPECT_FALSE(finger.slipping);
}

TEST(FingertipTest, AFingerDrawnAwayLiftsOffFollowsItsTargetAndPressesAgain) {
  const World world(MakeHeldCube());
  WorldState state = world.InitialState();
  world.PutFinger(state, Finger::kIndex, Vector3(0.0, 0.0, 0.05));
  FingertipState& finger = state.fingers[kIndex];
  finger.p_WTarget = Vector3(0.0, 0.0, 0.15);  // the cube's top is at 0.1
  Simulate(world, 1.0, &state);
  EXPECT_FALSE(finger.touching);
  EXPECT_EQ(finger.f_W, Vector3::Zero());
  EXPECT_LT((finger.p_WF - finger.p_WTarget).norm(), 1e-3);
  finger.p_WTarget = Vector3(0.02, 0.01, 0.11);
  Simulate(world, 1.0, &state);
  EXPECT_FALSE(finger.touching);
  EXPECT_LT((finger.p_OC - Vector3(0.02, 0.01, 0.05)).norm(), 1e-3);
  for (int i = 0; i < 240; ++i) {
    finger.p_WTarget.z() = 0.11 - 0.03 * std::min(1.0, i / 120.0);
    world.Step(state);
    ASSERT_GE(finger.p_WF.z(), 0.1 - 1e-6);
  }
  EXPECT_TRUE(finger.touching);
  EXPECT_NEAR(finger.f_W.z(), -50.0 * 0.02, 1e-3);
}

TEST(FingertipTest, AFreeFingerRelaxesWithTheTimeConstantDampingOverStiffness) {
  Scene scene = MakeHeldCube();
  const double b = scene.fingertips.damping * std::sqrt(50.0 * 0.5), tau = b / 50.0;
  StepConfig config;
  config.dt = 1e-4;
  const World world(scene, config);
  WorldState state = world.InitialState();
  world.PutFinger(state, Finger::kIndex, Vector3(0.0, 0.0, 0.05));
  state.fingers[kIndex].p_WTarget.z() += 0.1;
  Simulate(world, tau, &state);
  EXPECT_NEAR(state.fingers[kIndex].p_WF.z(), 0.1 + 0.1 * (1.0 - std::exp(-1.0)), 1e-4);
}

TEST(FingertipTest, EachFingerPushesWithItsOwnStiffness) {
  const World world(MakeHeldCube());
  WorldState state = world.InitialState();
  for (int f = 0; f < kNumFingers; ++f) {
    world.PutFinger(state, static_cast<Finger>(f), Vector3(0.02 * (f - 2), 0.01 * f, 0.05));
    EXPECT_EQ(state.fingers[f].stiffness, 50.0);
    world.SetStiffness(state, static_cast<Finger>(f), 100.0 * (f + 1));
    EXPECT_NEAR(state.fingers[f].damping, 0.7 * std::sqrt(100.0 * (f + 1) * 0.5), 1e-12);
    state.fingers[f].p_WTarget += Vector3(0.001, 0.0, -0.004);
  }
  Simulate(world, 0.5, &state);
  for (int f = 0; f < kNumFingers; ++f) {
    const Vector3 expected = 100.0 * (f + 1) * Vector3(0.001, 0.0, -0.004);
    EXPECT_LT((state.fingers[f].f_W - expected).norm(), 1e-3) << f;
  }
}

TEST(FingertipTest, AFingerAtRestKeepsItsForceWhenItsStiffnessChanges) {
  // Sticking, at the cone's limit, and at the cap.
  for (const Vector3& offset :
       {Vector3(0.02, 0.01, -0.05), Vector3(0.03, 0.01, -0.02), Vector3(0.1, -0.05, -0.4)}) {
    const World world(MakeHeldCube());
    WorldState state = world.InitialState();
    world.PutFinger(state, Finger::kIndex, Vector3(0.0, 0.0, 0.05));
    FingertipState& finger = state.fingers[kIndex];
    finger.p_WTarget += offset;
    Simulate(world, 2.0, &state);
    const Vector3 f_W = finger.f_W;
    const double slip = finger.slip;
    for (const double stiffness : {300.0, 50.0, 600.0}) {
      world.SetStiffness(state, Finger::kIndex, stiffness);
      EXPECT_LT((finger.p_WTarget - finger.p_WF - finger.f_W / stiffness).norm(), 1e-6);
      for (int i = 0; i < 60; ++i) {
        world.Step(state);
        ASSERT_LT((finger.f_W - f_W).norm(), 1e-3) << stiffness << " N/m, step " << i;
      }
    }
    EXPECT_NEAR(finger.slip, slip, 1e-5);
  }
}

TEST(FingertipTest, AFingerThatPushesAMovingObjectKeepsItsForceWhenItsStiffnessChanges) {
  const World world(MakeScene(MakeBox("box", Vector3(0.1, 0.08, 0.06), At(0, 0, 0.03), 0.4, 0.2)));
  WorldState state = world.InitialState();
  world.PutFinger(state, Finger::kIndex, Vector3(-0.05, 0.0, 0.0));
  FingertipState& finger = state.fingers[kIndex];
  for (int i = 0; i < 60; ++i) {
    finger.p_WTarget.x() += 0.2 * world.config().dt;
    world.Step(state);
  }
  const double speed = state.bodies[0].v_WB.x();
  ASSERT_GT(speed, 0.1);
  const double force = finger.f_W.x();
  world.SetStiffness(state, Finger::kIndex, 300.0);
  finger.p_WTarget.x() += speed * world.config().dt;
  world.Step(state);
  // The damper alone bears 1 N.
  EXPECT_GT(finger.damping * speed, 0.8);
  EXPECT_NEAR(finger.f_W.x(), force, 0.05);
}

TEST(FingertipTest, AFreeFingerStaysWhereItIsWhenItsStiffnessChanges) {
  const World world(MakeHeldCube());
  WorldState state = world.InitialState();
  world.PutFinger(state, Finger::kIndex, Vector3(0.0, 0.0, 0.05));
  FingertipState& finger = state.fingers[kIndex];
  finger.p_WTarget.z() += 0.05;
  Simulate(world, 2.0, &state);
  const FingertipState before = finger;
  world.SetStiffness(state, Finger::kIndex, 300.0);
  EXPECT_EQ(finger.p_WTarget, before.p_WTarget);
  Simulate(world, 0.1, &state);
  EXPECT_EQ(finger.f_W, Vector3::Zero());
  EXPECT_LT((finger.p_WF - before.p_WF).norm(), 1e-6);
}

TEST(FingertipTest, AFingerThatIsOffHasNoStiffnessToChange) {
  const World world(MakeHeldCube());
  WorldState state = world.InitialState();
  EXPECT_THROW(world.SetStiffness(state, Finger::kIndex, 300.0), InternalError);
  world.PutFinger(state, Finger::kIndex, Vector3(0.0, 0.0, 0.05));
  EXPECT_THROW(world.SetStiffness(state, Finger::kIndex, 0.0), InternalError);
}

TEST(FingertipTest, AFingerThatSlipsPastAnEdgeLeavesTheSurface) {
  const World world(MakeHeldCube());
  WorldState state = world.InitialState();
  world.PutFinger(state, Finger::kIndex, Vector3(0.04, 0.0, 0.05));
  state.fingers[kIndex].p_WTarget = Vector3(0.15, 0.0, 0.09);
  Simulate(world, 1.0, &state);
  EXPECT_FALSE(state.fingers[kIndex].touching);
  EXPECT_LT((state.fingers[kIndex].p_WF - state.fingers[kIndex].p_WTarget).norm(), 1e-3);
}

TEST(FingertipTest, ADraggedBoxMovesWhenSpringForceExceedsFriction) {
  // Pressing with f_n and dragging: the box slides once f_t > mu_env (m g + f_n).
  const double mass = 0.2, mu = 0.3, press = 2.0;
  const double threshold = mu * (mass * 9.81 + press);  // 1.19 N, inside the finger's cone of 1.6 N
  for (const double factor : {0.97, 1.03}) {
    StepConfig config;
    config.tolerance = 1e-6;
    const World world(MakeScene(MakeBox("box", Vector3(0.2, 0.1, 0.02), At(0, 0, 0.01), mass, mu),
                                {MakeTable(0.5)}),
                      config);
    WorldState state = world.InitialState();
    world.PutFinger(state, Finger::kIndex, Vector3(0.0, 0.0, 0.01));
    FingertipState& finger = state.fingers[kIndex];
    const Vector3 start = finger.p_WF;
    for (int i = 0; i < 480; ++i) {
      // The target travels with the finger, so that the force stays what it is.
      const double ramp = std::min(1.0, i / 240.0);
      finger.p_WTarget = finger.p_WF + Vector3(ramp * factor * threshold, 0.0, -press) / 50.0;
      world.Step(state);
    }
    EXPECT_EQ(finger.slip, 0.0);
    const double moved = (finger.p_WF - start).norm();
    if (factor < 1.0) {
      EXPECT_LT(moved, 1e-5);
    } else {
      EXPECT_GT(moved, 1e-3);
    }
  }
}

}  // namespace
}  // namespace pregrasp
