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
