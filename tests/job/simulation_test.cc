#include "app/job/simulation.h"

#include <gtest/gtest.h>

#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/job/motion_measure.h"
#include "tests/job/fixture.h"

namespace pregrasp {
namespace {

Simulation MakeSimulation() {
  auto world = std::make_shared<const World>(MakeRulerScene());
  return {world, world->InitialState()};
}

bool SameState(const WorldState& a, const WorldState& b) {
  return a.step == b.step && a.t == b.t && a.bodies[0].p_WB == b.bodies[0].p_WB &&
         a.bodies[0].q_WB.coeffs() == b.bodies[0].q_WB.coeffs() &&
         a.bodies[0].v_WB == b.bodies[0].v_WB && a.fingers[1].p_WTarget == b.fingers[1].p_WTarget &&
         a.fingers[1].f_W == b.fingers[1].f_W;
}

TEST(SimulationTest, GoingBackAndOnAgainGivesTheSameStates) {
  Simulation sim = MakeSimulation();
  sim.Touch(Finger::kIndex, {0.11, 0, 0.0015});
  sim.Move(Finger::kIndex, sim.state().fingers[1].p_WTarget - Vector3(0, 0, 0.012), 0.25);
  const Simulation before = sim;
  const Vector3 target = sim.state().fingers[1].p_WTarget + Vector3(0.02, 0, 0);
  sim.Move(Finger::kIndex, target, 0.5);
  const WorldState after = sim.state();
  sim.Back(120);
  EXPECT_TRUE(SameState(sim.state(), before.state()));
  sim.Move(Finger::kIndex, target, 0.5);
  EXPECT_TRUE(SameState(sim.state(), after));
}

TEST(SimulationTest, AForkDoesNotChangeWhereItCameFrom) {
  Simulation sim = MakeSimulation();
  Simulation fork = sim;
  fork.Touch(Finger::kThumb, {0, 0, 0.0015});
  fork.Step(10);
  EXPECT_EQ(sim.num_states(), 1);
  EXPECT_FALSE(sim.state().fingers[0].on);
  EXPECT_EQ(fork.num_states(), 11);
}

TEST(SimulationTest, RefusesWhatMakesNoSense) {
  Simulation sim = MakeSimulation();
  EXPECT_THROW(sim.Move(Finger::kIndex, Vector3::Zero(), 1.0), InputError);  // it is off
  EXPECT_THROW(sim.Back(1), InputError);
  EXPECT_THROW(sim.Step(-1), InputError);
  EXPECT_THROW(sim.Step(1 << 30), InputError);
  EXPECT_THROW(sim.StepsIn(-1.0), InputError);
  sim.Touch(Finger::kIndex, {0, 0, 0.0015});
  EXPECT_THROW(sim.Move(Finger::kIndex, Vector3::Zero(), 0.0), InputError);
  EXPECT_THROW(sim.Move(Finger::kIndex, Vector3(1e300, 0.0, 0.0), 1.0), InputError);
}

TEST(SimulationTest, ATracedOneTakesTheSameStepsAndTellsTheirEnergies) {
  const auto world = std::make_shared<const World>(MakeRulerScene());
  Simulation plain(world, world->InitialState());
  Simulation traced(world, world->InitialState(), true);
  for (Simulation* sim : {&plain, &traced}) {
    sim->Touch(Finger::kIndex, {0.11, 0, 0.0015});
    sim->Move(Finger::kIndex, Vector3(-0.03, 0, -0.01), 0.5);
  }
  EXPECT_TRUE(SameState(plain.state(), traced.state()));
  ASSERT_EQ(plain.contacts().size(), traced.contacts().size());
  const int last = traced.num_states() - 1;
  const double energy =
      traced.trace_at(last).kinetic_energy + traced.trace_at(last).potential_energy;
  EXPECT_NEAR(energy, world->CalcEnergy(traced.state()), 1e-15);
  EXPECT_GT(traced.trace_at(last).kinetic_energy, 0.0);
}

TEST(SimulationTest, AnInterruptKeepsWhatWasStepped) {
  Simulation sim = MakeSimulation();
  sim.Step(5);
  RequestInterrupt();
  EXPECT_THROW(sim.Step(5), Interrupted);
  ClearInterrupt();
  EXPECT_EQ(sim.num_states(), 6);
  EXPECT_NO_THROW(sim.Step(5));
}

TEST(SettleTest, TheRulerStaysAtRest) {
  const World world(MakeRulerScene());
  WorldState state = world.InitialState();
  const SettleResult result = Settle(world, state, 1.0);
  EXPECT_TRUE(result.at_rest);
  EXPECT_LT(result.largest.moved, 1e-6);
}

}  // namespace
}  // namespace pregrasp
