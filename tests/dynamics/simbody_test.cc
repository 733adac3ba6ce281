// The kernel against its oracle: the same contact core run through Simbody's State and operators.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "app/dynamics/world.h"
#include "tests/dynamics/scenes.h"

namespace pregrasp {
namespace {

// Runs both steppers from `state`, ten steps at a time, and returns the largest difference (of
// velocities relative to 1 + their size, of forces relative to 1 N).
// @param before_step  what happens to both states before a step.
double CompareSteppers(
    const World& world, int blocks, WorldState* state,
    const std::function<void(WorldState*)>& before_step = [](WorldState*) {}) {
  double largest = 0.0;
  for (int block = 0; block < blocks; ++block) {
    WorldState oracle = *state;
    for (int i = 0; i < 10; ++i) {
      before_step(state);
      before_step(&oracle);
      world.Step(*state);
      world.StepWithSimbody(oracle);
      for (std::size_t b = 0; b < state->bodies.size(); ++b) {
        const BodyState &x = state->bodies[b], &y = oracle.bodies[b];
        const double scale = 1.0 + x.v_WB.norm() + x.w_WB.norm();
        largest = std::max({largest, (x.p_WB - y.p_WB).norm(), (x.v_WB - y.v_WB).norm() / scale,
                            (x.w_WB - y.w_WB).norm() / scale,
                            (x.q_WB.coeffs() - y.q_WB.coeffs()).norm()});
      }
      for (int f = 0; f < kNumFingers; ++f) {
        const FingertipState &x = state->fingers[f], &y = oracle.fingers[f];
        largest = std::max({largest, (x.p_WF - y.p_WF).norm(), (x.p_WTarget - y.p_WTarget).norm(),
                            (x.f_W - y.f_W).norm() / (1.0 + x.f_W.norm())});
      }
    }
  }
  return largest;
}

TEST(SimbodyTest, StepAgreesWithSimbodyTo1em12OverTenStepsOnATippingPushedOffCentreBody) {
  // Products of inertia and a centre of mass off the origin: nothing cancels by symmetry.
  Body box = MakeBox("box", Vector3(0.1, 0.08, 0.06), At(0, 0, 0.035, Vector3(3, 2, 40)), 0.4, 0.4);
  MassProperties& mass = *box.mass_properties;
  mass.p_BoBcm = Vector3(0.01, -0.008, 0.004);
  mass.I_BBcm(0, 1) = mass.I_BBcm(1, 0) = 4e-5;
  mass.I_BBcm(1, 2) = mass.I_BBcm(2, 1) = -3e-5;
  const World world(MakeScene(box, {MakeTable(), MakeFixed("wall", Box{Vector3(0.02, 0.5, 0.5)},
                                                           At(-0.09, 0, 0.25), 0.3)}));
  WorldState state = world.InitialState();
  state.bodies[0].w_WB = Vector3(0.5, -2.0, 1.0);
  state.bodies[0].v_WB = Vector3(0.4, 0.1, -0.3);
  world.PutFinger(state, Finger::kIndex, Vector3(0.01, 0.0, 0.03));
  world.PutFinger(state, Finger::kThumb, Vector3(-0.05, 0.01, 0.0));
  state.fingers[0].p_WTarget += Vector3(0.05, 0.02, 0.0);
  state.fingers[1].p_WTarget += Vector3(0.01, 0.06, -0.04);
  EXPECT_LT(CompareSteppers(world, 20, &state), 1e-12);
}

TEST(SimbodyTest, StepAgreesWithSimbodyTo1em12OverTenStepsWithAMovableNeighbour) {
  const World world(MakeScene(
      MakeBox("box", Vector3(0.1, 0.08, 0.06), At(0, 0, 0.03), 0.4, 0.4),
      {MakeTable(), MakeBox("neighbour", Vector3(0.05, 0.1, 0.12), At(0.08, 0, 0.06), 0.6, 0.3)}));
  WorldState state = world.InitialState();
  world.PutFinger(state, Finger::kIndex, Vector3(-0.05, 0.0, 0.0));
  state.fingers[1].p_WTarget += Vector3(0.15, 0.02, 0.0);
  EXPECT_LT(CompareSteppers(world, 20, &state), 1e-12);
}

TEST(SimbodyTest, StepAgreesWithSimbodyTo1em12ForEveryKindOfShape) {
  Rng rng(5);
  // Round rims against edges are left to the table and the wall: their nearest points come from a
  // search that ends within 1e-7 of the direction, and would only show that.
  const Body wall = MakeFixed("wall", Box{Vector3(0.02, 1, 1)}, At(0.08, 0, 0.5), 0.3);
  const Body ridge =
      MakeFixed("ridge", Box{Vector3(0.3, 0.03, 0.03)}, At(0.01, 0.03, 0, Vector3(45, 0, 20)), 0.3);
  const std::vector<std::pair<Shape, Body>> cases = {
      {Cylinder{0.03, 0.1}, wall},
      {Capsule{0.02, 0.06}, ridge},
      {Sphere{0.03}, ridge},
      {MakeHook(), ridge},
      {MakePlateUnion(), wall},
      {MakeRandomHull(rng, 20, Vector3(0.06, 0.05, 0.04)), ridge},
      {testing::MakeMesh(testing::MakeC(0.05, 0.04)), ridge},
      {testing::MakeMesh(testing::MakeCup(0.04, 0.08, 0.004, 24)), ridge},
  };
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const double x = ShapeKind(cases[i].first) == std::string("union") ? -0.08 : 0.0;
    const World world(MakeScene(
        MakeMovable("body", cases[i].first, At(x, 0, 0.15, Vector3(20, 50, 10)), 0.3, 0.4),
        {MakeTable(), cases[i].second}));
    WorldState state = world.InitialState();
    state.bodies[0].w_WB = Vector3(1.0, 2.0, 0.5);
    state.bodies[0].v_WB = Vector3(0.3, 0.0, 0.0);
    EXPECT_LT(CompareSteppers(world, 10, &state), 1e-12) << "case " << i;
  }
}

TEST(SimbodyTest, StepAgreesWithSimbodyTo1em12WithFiveFingersWhoseSpringsChangeBetweenSteps) {
  const World world(MakeScene(MakeBox("box", Vector3(0.1, 0.08, 0.06), At(0, 0, 0.03), 0.4, 0.4)));
  WorldState state = world.InitialState();
  const Vector3 p_OC[kNumFingers] = {
      {-0.05, 0, 0}, {0.05, -0.03, 0}, {0.05, -0.01, 0}, {0.05, 0.01, 0}, {0.05, 0.03, 0}};
  for (int f = 0; f < kNumFingers; ++f) {
    world.PutFinger(state, static_cast<Finger>(f), p_OC[f]);
    state.fingers[f].p_WTarget += Vector3(f == 0 ? 0.08 : -0.01, 0.01 * (f - 2), 0.004 * f);
  }
  const double stiffnesses[] = {300.0, 50.0, 150.0, 600.0};
  EXPECT_LT(CompareSteppers(world, 20, &state,
                            [&](WorldState* s) {
                              // One finger a step, so that fingers of different springs meet.
                              const int f = static_cast<int>(s->step % kNumFingers);
                              world.SetStiffness(*s, static_cast<Finger>(f),
                                                 stiffnesses[s->step % 4]);
                            }),
            1e-12);
  for (const FingertipState& tip : state.fingers) EXPECT_GT(tip.f_W.norm(), 0.0);
}

TEST(SimbodyTest, StepAgreesWithSimbodyTo1em12UnderAnOuterForceOffTheBodysOrigin) {
  Body box = MakeBox("box", Vector3(0.1, 0.08, 0.06), At(0, 0, 0.035, Vector3(3, 2, 40)), 0.4, 0.4);
  box.mass_properties->p_BoBcm = Vector3(0.01, -0.008, 0.004);
  const World world(MakeScene(box, {MakeTable(), MakeBox("neighbour", Vector3(0.05, 0.1, 0.12),
                                                         At(0.15, 0, 0.06), 0.6, 0.3)}));
  WorldState state = world.InitialState();
  state.f_Ocm_W = Vector3(3.0, 1.0, 2.0);
  EXPECT_LT(CompareSteppers(world, 20, &state), 1e-12);
}

TEST(SimbodyTest, StepAgreesWithSimbodyTo1em12WhileAnOverlapIsPushedOut) {
  const World world(MakeScene(MakeBox("box", Vector3(0.1, 0.08, 0.06), At(0, 0, 0.028), 0.4, 0.4)));
  WorldState state = world.InitialState();
  EXPECT_LT(CompareSteppers(world, 10, &state), 1e-12);
}

}  // namespace
}  // namespace pregrasp
