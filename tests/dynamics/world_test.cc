#include "app/dynamics/world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "app/core/error.h"
#include "tests/dynamics/scenes.h"

namespace pregrasp {
namespace {

Scene MakeBoxOnTable() {
  return MakeScene(MakeBox("box", Vector3(0.1, 0.08, 0.06), At(0, 0, 0.03), 0.3, 0.5));
}

TEST(WorldTest, TheInitialStateIsTheSceneAtRest) {
  Scene scene = MakeBoxOnTable();
  scene.object().X_WB = At(0.1, -0.2, 0.5, Vector3(10, 20, 30));
  scene.bodies.push_back(MakeMovable("hook", MakeHook(), At(0.3, 0, 0.2), 0.2, 0.4));
  const World world(scene);
  const WorldState state = world.InitialState();
  ASSERT_EQ(world.num_movables(), 2);
  EXPECT_EQ(world.body_index(MovableIndex{0}), kObjectBody);
  EXPECT_EQ(world.body_index(MovableIndex{1}), BodyIndex{2});
  EXPECT_EQ(world.movable_index(BodyIndex{2}), MovableIndex{1});
  EXPECT_TRUE(world.movable_index(BodyIndex{1}).is_none());
  const std::vector<RigidTransform> X_WB = world.GetPoses(state);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    EXPECT_LT((X_WB[i].matrix() - scene.bodies[i].X_WB.matrix()).norm(), 1e-14) << i;
  }
  for (const BodyState& body : state.bodies) {
    EXPECT_EQ(body.v_WB.norm() + body.w_WB.norm(), 0.0);
  }
}

TEST(WorldTest, FreeFallFollowsTheParabola) {
  Scene scene = MakeBoxOnTable();
  scene.object().X_WB = At(0, 0, 2.0, Vector3(10, 20, 30));
  const World world(scene);
  WorldState state = world.InitialState();
  state.bodies[0].v_WB = Vector3(0.5, -0.3, 1.0);
  Simulate(world, 0.5, &state);
  // Semi-implicit Euler: t (t + h) / 2 instead of t^2 / 2.
  const double fall = 0.5 * kGravity * 0.5 * (0.5 + world.config().dt);
  EXPECT_LT((state.bodies[0].p_WB - Vector3(0.25, -0.15, 2.5 - fall)).norm(), 1e-12);
}

TEST(WorldTest, FreeTumblingKeepsAngularMomentumAndNearlyItsEnergy) {
  Scene scene = MakeScene(MakeBox("box", Vector3(0.1, 0.08, 0.03), At(0, 0, 2.0), 0.3, 0.5));
  scene.gravity.setZero();
  const World world(scene);
  WorldState state = world.InitialState();
  state.bodies[0].w_WB = Vector3(0.1, 8.0, 0.2);  // about the middle axis: it flips over
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

TEST(WorldTest, ContactBetweenMovablesKeepsMomentum) {
  // Two bodies meet off-centre, with friction, far from anything fixed.
  Scene scene = MakeScene(
      MakeBox("box", Vector3(0.1, 0.08, 0.06), At(0, 0, 1.0), 0.3, 0.5),
      {MakeTable(),
       MakeMovable("hook", MakeHook(), At(0.2, 0.03, 1.02, Vector3(0, 40, 0)), 0.4, 0.5)});
  scene.gravity.setZero();
  const World world(scene);
  WorldState state = world.InitialState();
  state.bodies[0].v_WB = Vector3(1.0, 0.0, 0.0);
  state.bodies[0].w_WB = Vector3(0.0, 3.0, 1.0);
  const auto momenta = [&] {
    Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
    for (int i = 0; i < 2; ++i) {
      const MassProperties& mass =
          *scene.bodies[world.body_index(MovableIndex{i}).value].mass_properties;
      const BodyState& body = state.bodies[i];
      const Matrix3 R = body.q_WB.toRotationMatrix();
      const Vector3 c = R * mass.p_BoBcm, v = body.v_WB + body.w_WB.cross(c);
      sum.head<3>() += mass.mass * v;
      sum.tail<3>() +=
          mass.mass * (body.p_WB + c).cross(v) + R * mass.I_BBcm * R.transpose() * body.w_WB;
    }
    return sum;
  };
  const auto before = momenta();
  const double energy = world.CalcEnergy(state);
  Simulate(world, 0.5, &state);
  EXPECT_LT((momenta() - before).head<3>().norm(), 1e-14);
  // Pushing out an overlap of micrometres moves the bodies without momentum.
  EXPECT_LT((momenta() - before).tail<3>().norm(), 1e-4 * before.tail<3>().norm());
  EXPECT_LT(world.CalcEnergy(state), 0.9 * energy) << "they did not meet";
}

TEST(WorldTest, ContactPointsCarryTheWeight) {
  const World world(MakeBoxOnTable());
  WorldState state = world.InitialState();
  Simulate(world, 0.5, &state);
  std::vector<ContactPoint> contacts;
  world.Step(state, &contacts);
  ASSERT_EQ(contacts.size(), 4U);
  Vector3 force = Vector3::Zero();
  for (const ContactPoint& contact : contacts) {
    EXPECT_EQ(contact.body_a, kObjectBody);
    EXPECT_EQ(contact.body_b, BodyIndex{1});
    EXPECT_LT((contact.nhat_W + Vector3::UnitZ()).norm(), 1e-9);  // from the box to the table
    EXPECT_NEAR(std::abs(contact.p_WC.x()), 0.05, 1e-6);
    EXPECT_NEAR(std::abs(contact.p_WC.y()), 0.04, 1e-6);
    EXPECT_LT(std::abs(contact.phi), 1e-6);
    EXPECT_LT(contact.v_slip_W.norm(), 1e-4);
    force += contact.f_W;
  }
  EXPECT_LT((force - Vector3(0, 0, -0.3 * kGravity)).norm(), 1e-4);
}

TEST(WorldTest, AStepThatDoesNotConvergeSaysHowFastBodiesStillApproach) {
  const Scene scene = MakeScene(
      MakeBox("heavy", Vector3(0.1, 0.1, 0.1), At(0, 0, 0.06), 1.6, 0.4),
      {MakeTable(), MakeBox("light", Vector3(0.1, 0.1, 0.01), At(0, 0, 0.005), 0.2, 0.4)});
  StepConfig config;
  config.max_sweeps = 1;
  for (const bool simbody : {false, true}) {
    const World world(scene, config);
    WorldState state = world.InitialState();
    const Convergence first = simbody ? world.StepWithSimbody(state) : world.Step(state);
    EXPECT_FALSE(first.converged);
    // A share of gravity's velocity is left, and in the step the gap above or below the light body
    // closes that fast.
    EXPECT_GT(first.residual, 0.05 * kGravity * config.dt);
    EXPECT_LT(first.residual, 1.001 * kGravity * config.dt);
    const double above = state.bodies[0].p_WB.z() - state.bodies[1].p_WB.z() - 0.055;
    const double below = state.bodies[1].p_WB.z() - 0.005;
    EXPECT_NEAR(std::min(above, below), -first.residual * config.dt, 1e-9);
  }
  const World world(scene);
  WorldState state = world.InitialState();
  for (int i = 0; i < 240; ++i) {
    const StepTrace trace = world.StepWithTrace(state);
    if (i > 10) {
      EXPECT_TRUE(trace.convergence.converged) << i;
      EXPECT_EQ(trace.convergence.residual, 0.0);
    }
  }
}

TEST(WorldTest, ATraceTellsOfASlidingBoxItsFrictionItsSlipAndTheEnergyTheyTake) {
  const double mass = 0.3, mu = 0.5;
  const World world(MakeBoxOnTable());
  WorldState state = world.InitialState();
  state.bodies[0].v_WB = Vector3(0.8, 0.3, 0.0);
  Simulate(world, 0.05, &state);
  WorldState untraced = state;
  const double before = world.CalcEnergy(state);
  double after = 0.0, work = 0.0;
  for (int i = 0; i < 12; ++i) {
    const Vector3 v_before = state.bodies[0].v_WB;
    const StepTrace trace = world.StepWithTrace(state);
    const Vector3 v_mean = 0.5 * (v_before + state.bodies[0].v_WB);
    world.Step(untraced);
    ASSERT_EQ(BytesOf(state), BytesOf(untraced));
    ASSERT_EQ(trace.contacts.size(), 4U);
    for (const ContactPoint& contact : trace.contacts) {
      const double f_n = contact.f_W.dot(contact.nhat_W);
      const Vector3 f_t = contact.f_W - f_n * contact.nhat_W;
      ASSERT_GT(f_n, 0.0);
      EXPECT_NEAR(f_t.norm(), mu * f_n, 1e-9);
      // The table (body b) slips backwards under the box and is dragged along.
      EXPECT_LT(f_t.normalized().dot(contact.v_slip_W.normalized()), -0.9999);
      EXPECT_LT((contact.v_slip_W + state.bodies[0].v_WB).norm(), 0.01);
      work -= f_t.dot(v_mean) * world.config().dt;
    }
    EXPECT_LT(trace.max_penetration, 1e-6);
    after = trace.kinetic_energy + trace.potential_energy;
    EXPECT_NEAR(trace.kinetic_energy, 0.5 * mass * state.bodies[0].v_WB.squaredNorm(), 1e-6);
  }
  EXPECT_NEAR(after - before, work, 1e-3 * std::abs(work));
}

TEST(WorldTest, ATraceTellsHowDeepABoxStartedInItsTable) {
  Scene scene = MakeBoxOnTable();
  scene.object().X_WB = At(0, 0, 0.0295);
  const World world(scene);
  WorldState state = world.InitialState();
  EXPECT_NEAR(world.StepWithTrace(state).max_penetration, 5e-4, 1e-12);
}

TEST(WorldTest, EnergyIsKineticPlusPotential) {
  const World world(MakeBoxOnTable());
  WorldState state = world.InitialState();
  state.bodies[0].p_WB.z() = 0.7;
  state.bodies[0].v_WB = Vector3(1, 2, 3);
  state.bodies[0].w_WB = Vector3(4, 0, 0);
  const double inertia = world.scene().object().mass_properties->I_BBcm(0, 0);
  EXPECT_NEAR(world.CalcEnergy(state),
              0.5 * 0.3 * 14.0 + 0.5 * inertia * 16.0 + 0.3 * kGravity * 0.7, 1e-12);
}

TEST(WorldTest, RestoringAStateInTheMiddleOfContactContinuesToTheSameBytes) {
  const World world(MakeScene(
      MakeMovable("plate", MakePlateUnion(), At(0, 0, 0.02, Vector3(5, 3, 20)), 0.5, 0.3),
      {MakeTable(), MakeMovable("bottle", Cylinder{0.03, 0.2}, At(0.17, 0, 0.1), 0.5, 0.3),
       MakeMovable("hook", MakeHook(), At(-0.2, 0.05, 0.03), 0.2, 0.4)}));
  WorldState state = world.InitialState();
  world.PutFinger(state, Finger::kIndex, Vector3(-0.13, 0.0, 0.02));
  world.PutFinger(state, Finger::kThumb, Vector3(0.0, 0.05, 0.03));
  Rng rng(7);
  const auto move = [](WorldState* s) {
    s->fingers[1].p_WTarget.x() += 0.1 / 240.0;
    s->fingers[0].p_WTarget.z() -= 0.05 / 240.0;
  };
  std::vector<WorldState> saved;
  std::vector<int> saved_at;
  std::vector<std::string> later;
  for (int i = 0; i < 300; ++i) {
    if (rng.Uniform() < 0.05) {
      saved.push_back(state);
      saved_at.push_back(i);
    }
    move(&state);
    world.Step(state);
    later.push_back(BytesOf(state));
  }
  ASSERT_GT(saved.size(), 5U);
  for (std::size_t k = 0; k < saved.size(); ++k) {
    WorldState restored = saved[k];
    for (int i = saved_at[k]; i < 300; ++i) {
      move(&restored);
      world.Step(restored);
      ASSERT_EQ(BytesOf(restored), later[i]) << "saved at " << saved_at[k] << ", step " << i;
    }
  }
}

TEST(WorldTest, BadSettingsAreRefused) {
  const Scene scene = MakeBoxOnTable();
  StepConfig config;
  config.dt = 0.0;
  EXPECT_THROW(World(scene, config), InputError);
  config = {};
  config.max_sweeps = 0;
  EXPECT_THROW(World(scene, config), InputError);
  config = {};
  config.restitution = 1.5;
  EXPECT_THROW(World(scene, config), InputError);
}

TEST(WorldTest, AnInertiaNoBodyCanHaveIsRefused) {
  Scene scene = MakeBoxOnTable();
  scene.object().mass_properties->I_BBcm = Vector3(1e-3, 1e-5, 1e-5).asDiagonal();
  EXPECT_THROW(World{scene}, InputError);
  scene.object().mass_properties->I_BBcm.setZero();
  EXPECT_THROW(World{scene}, InputError);
}

}  // namespace
}  // namespace pregrasp
