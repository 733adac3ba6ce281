#include <gtest/gtest.h>

#include "tests/dynamics/scenes.h"

namespace pregrasp {
namespace {

double CalcFastest(const WorldState& state) {
  double fastest = 0.0;
  for (const BodyState& body : state.bodies) fastest = std::max(fastest, body.v_WB.norm());
  return fastest;
}

// Boxes one on another, each turned and shifted a little; masses by turns.
World MakeStack(int count, double odd_mass, double even_mass) {
  std::vector<Body> environment = {MakeTable()};
  Body object;
  for (int i = 0; i < count; ++i) {
    const Body box = MakeBox("b" + std::to_string(i), Vector3(0.06, 0.05, 0.04),
                             At(0.002 * (i % 3), 0.001 * i, 0.02 + 0.04 * i, Vector3(0, 0, 7 * i)),
                             i % 2 == 0 ? even_mass : odd_mass, 0.5);
    if (i == 0) {
      object = box;
    } else {
      environment.push_back(box);
    }
  }
  return World(MakeScene(object, std::move(environment)));
}

TEST(StackTest, StacksOfBoxesComeToRestAndStayWhereTheyWerePut) {
  struct Case {
    int count;
    double odd_mass, even_mass;
  };
  for (const Case& c :
       {Case{5, 0.2, 0.2}, Case{8, 0.2, 0.2}, Case{5, 1.0, 0.1}, Case{5, 0.1, 1.0}}) {
    const World world = MakeStack(c.count, c.odd_mass, c.even_mass);
    WorldState state = world.InitialState();
    const WorldState start = state;
    Simulate(world, 8.0, &state);
    double fastest = 0.0;
    for (int i = 0; i < 480; ++i) {
      world.Step(state);
      fastest = std::max(fastest, CalcFastest(state));
    }
    EXPECT_LT(fastest, c.count > 5 ? 2e-4 : 1e-4)
        << c.count << " boxes of " << c.odd_mass << " and " << c.even_mass;
    for (int i = 0; i < c.count; ++i) {
      EXPECT_LT((state.bodies[i].p_WB - start.bodies[i].p_WB).norm(), 1e-4) << c.count << ", " << i;
    }
  }
}

TEST(StackTest, AHeavyBodyRestsOnALightOneWhateverTheRatioOfTheirMasses) {
  const Body jar = MakeMovable("heavy", Cylinder{0.045, 0.14}, At(0, 0, 0.074), 1.8, 0.4);
  const Body crate = MakeBox("heavy", Vector3(0.2, 0.25, 0.08), At(0, 0, 0.044), 1.8, 0.4);
  for (const double ratio : {20.0, 80.0, 150.0, 400.0, 900.0}) {
    const double mass = 1.8 / ratio;
    const Body coaster = MakeMovable("light", Cylinder{0.025, 0.004}, At(0, 0, 0.002), mass, 0.4);
    const Body strip = MakeBox("light", Vector3(0.24, 0.025, 0.004), At(0, 0, 0.002), mass, 0.4);
    for (const auto& [heavy, light] : {std::pair(jar, coaster), std::pair(crate, strip)}) {
      const World world(MakeScene(heavy, {MakeTable(), light}));
      WorldState state = world.InitialState();
      double overlap = 0.0;
      for (int i = 0; i < 480; ++i) {
        overlap = std::max(overlap, world.StepWithTrace(state).max_penetration);
      }
      const std::string what = heavy.name + " on " + light.name + ", " + std::to_string(ratio);
      EXPECT_LT(overlap, 5e-5) << what;
      for (int i = 0; i < 2; ++i) {
        const Vector3 moved = state.bodies[i].p_WB - world.InitialState().bodies[i].p_WB;
        EXPECT_LT(moved.norm(), 5e-5) << what;
        EXPECT_LT(CalcTilt(state.bodies[i]), 1e-3) << what;
      }
    }
  }
}

TEST(StackTest, AHeavyBodyIsDroppedOnALightOneAndDoesNotSinkIn) {
  const World world(MakeScene(
      MakeBox("heavy", Vector3(0.2, 0.25, 0.08), At(0, 0.006, 0.05), 1.8, 0.4),
      {MakeTable(), MakeBox("light", Vector3(0.24, 0.025, 0.004), At(0, 0, 0.002), 0.004, 0.4)}));
  WorldState state = world.InitialState();
  double overlap = 0.0;
  for (int i = 0; i < 480; ++i) {
    overlap = std::max(overlap, world.StepWithTrace(state).max_penetration);
  }
  EXPECT_LT(overlap, 1e-4);
  EXPECT_NEAR(state.bodies[0].p_WB.z(), 0.044, 1e-5);
}

TEST(StackTest, ARowOfBooksBetweenWallsStaysAtRest) {
  std::vector<Body> environment = {
      MakeTable(0.3), MakeFixed("left", Box{Vector3(0.02, 0.3, 0.3)}, At(-0.0945, 0, 0.15), 0.3),
      MakeFixed("right", Box{Vector3(0.02, 0.3, 0.3)}, At(0.0945, 0, 0.15), 0.3)};
  const Vector3 size(0.033, 0.15, 0.2);
  for (const int i : {-2, -1, 1, 2}) {
    environment.push_back(
        MakeBox("b" + std::to_string(i + 2), size, At(0.0335 * i, 0, 0.1), 0.6, 0.3));
  }
  const World world(
      MakeScene(MakeBox("book", size, At(0, 0, 0.1), 0.6, 0.3), std::move(environment)));
  WorldState state = world.InitialState();
  Simulate(world, 5.0, &state);
  EXPECT_LT(CalcFastest(state), 1e-5);
}

}  // namespace
}  // namespace pregrasp
