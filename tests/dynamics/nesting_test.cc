#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/dynamics/scenes.h"

namespace pregrasp {
namespace {

const double kThicker = DecomposeConfig().concavity;  // than their mesh are bodies in contact [m]

// Vessels as profiles (distance from the axis, height) in metres.

// Tapered: the inside is 32.4 mm wide at the floor (z 3 mm) and 43 mm at the mouth (z 94 mm).
Shape MakeContainer() {
  return testing::MakeMesh(testing::Revolve({{0, 0},
                                             {0.035, 0},
                                             {0.046, 0.090},
                                             {0.052, 0.090},
                                             {0.052, 0.094},
                                             {0.043, 0.094},
                                             {0.0324, 0.003},
                                             {0, 0.003}},
                                            48));
}

// A disc on a plug that goes 6 mm into the container's mouth, 1 mm narrower than that.
Shape MakeLid() {
  return testing::MakeMesh(testing::Revolve(
      {{0, -0.006}, {0.0415, -0.006}, {0.042, 0}, {0.054, 0}, {0.054, 0.003}, {0, 0.003}}, 48));
}

// A plate with a foot ring; the next one's foot stands in its hollow.
Shape MakeDinnerPlate() {
  return testing::MakeMesh(testing::Revolve({{0, 0.004},
                                             {0.058, 0.004},
                                             {0.060, 0},
                                             {0.066, 0},
                                             {0.069, 0.005},
                                             {0.085, 0.008},
                                             {0.120, 0.020},
                                             {0.121, 0.022},
                                             {0.1195, 0.0235},
                                             {0.085, 0.0125},
                                             {0.066, 0.009},
                                             {0, 0.0085}},
                                            48));
}

double HeightAfter(const World& world, double seconds, int body, WorldState* state) {
  Simulate(world, seconds, state);
  return state->bodies[body].p_WB.z();
}

TEST(NestingTest, ALidSitsInItsMouth) {
  const World world(
      MakeScene(MakeMovable("lid", MakeLid(), At(0.0003, -0.0002, 0.0945), 0.05, 0.4),
                {MakeTable(0.4), MakeFixed("pot", MakeContainer(), At(0, 0, 0), 0.4)}));
  WorldState state = world.InitialState();
  EXPECT_NEAR(HeightAfter(world, 1.0, 0, &state), 0.094, kThicker);
  EXPECT_LT(CalcTilt(state.bodies[0]), 0.005);
}

// Outside they widen along the line (35, 0) to (46, 90) mm, inside along (32.4, 3) to (43, 94). The
// upper one sinks until its foot meets the lower one's wall or its wall the lower one's mouth.
TEST(NestingTest, TwoContainersNest) {
  const World world(
      MakeScene(MakeMovable("upper", MakeContainer(), At(0, 0, 0.035), 0.1, 0.4),
                {MakeTable(0.4), MakeFixed("lower", MakeContainer(), At(0, 0, 0), 0.4)}));
  WorldState state = world.InitialState();
  const double inner_slope = (0.043 - 0.0324) / (0.094 - 0.003);
  const double outer_slope = (0.046 - 0.035) / 0.090;
  const double at_mouth = 0.094 - (0.043 - 0.035) / outer_slope;
  const double at_foot = 0.003 + (0.035 - 0.0324) / inner_slope;
  const double nested = std::max(at_mouth, at_foot);
  // A wall that is thicker by half a millimetre holds it 4 mm higher.
  EXPECT_NEAR(HeightAfter(world, 2.0, 0, &state), nested, kThicker / outer_slope);
  EXPECT_LT(CalcTilt(state.bodies[0]), 0.05);
}

TEST(NestingTest, PlatesStackLevel) {
  std::vector<Body> around{MakeTable(0.4)};
  const Shape plate = MakeDinnerPlate();
  around.push_back(MakeMovable("second", plate, At(0.0005, 0, 0.0095), 0.5, 0.4));
  const World world(MakeScene(MakeMovable("first", plate, At(0, 0, 0), 0.5, 0.4), around));
  WorldState state = world.InitialState();
  Simulate(world, 1.0, &state);
  EXPECT_NEAR(state.bodies[0].p_WB.z(), 0.0, 1e-4);
  EXPECT_NEAR(state.bodies[1].p_WB.z(), 0.009, kThicker);
  EXPECT_LT(CalcTilt(state.bodies[1]), 0.003);
}

}  // namespace
}  // namespace pregrasp
