// Support spread: friction against turning on the spot like even pressure's, in closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "app/dynamics/support_spread.h"
#include "app/dynamics/world.h"
#include "tests/dynamics/scenes.h"

namespace pregrasp {
namespace {

constexpr double kFriction = 0.4, kMass = 0.3;

// Mean distance of a rectangle's points from its centre.
double MeanDistanceOfRectangle(double a, double b) {
  const double d = std::hypot(a, b);
  return (2.0 * d + a * a / b * std::log((b + d) / a) + b * b / a * std::log((a + d) / b)) / 12.0;
}

// The arm at which friction mu m g would slow the spin of `shape`, which rests on z = 0, as the
// simulated friction does: torque over mu m g [m].
double MeasureArm(const Shape& shape, double z, bool spread, std::vector<Body> ground) {
  StepConfig config;
  config.spread_support = spread;
  config.tolerance = 1e-7;
  config.max_sweeps = 200;
  const Scene scene =
      MakeScene(MakeMovable("body", shape, At(0, 0, z), kMass, kFriction), std::move(ground));
  const World world(scene, config);
  WorldState state = world.InitialState();
  Simulate(world, 0.1, &state);
  state.bodies[0].w_WB.z() = 20.0;
  Simulate(world, 2.0 * world.config().dt, &state);  // the pressure of a turning body
  const double before = state.bodies[0].w_WB.z();
  const double seconds = 0.05;
  Simulate(world, seconds, &state);
  const double slowing = (before - state.bodies[0].w_WB.z()) / seconds;
  return slowing * scene.object().mass_properties->I_BBcm(2, 2) / (kFriction * kMass * kGravity);
}

double MeasureArm(const Shape& shape, double z, bool spread) {
  return MeasureArm(shape, z, spread, {MakeTable()});
}

TEST(SpreadTest, ARectangleResistsTurningLikeEvenPressure) {
  for (const Vector2& size : {Vector2(0.1, 0.1), Vector2(0.1, 0.06), Vector2(0.3, 0.03)}) {
    const Box box{Vector3(size.x(), size.y(), 0.01)};
    const double corner = 0.5 * size.norm(), even = MeanDistanceOfRectangle(size.x(), size.y());
    EXPECT_NEAR(MeasureArm(box, 0.005, false), corner, 5e-3 * corner);
    EXPECT_NEAR(MeasureArm(box, 0.005, true), even, 5e-3 * even);
  }
}

TEST(SpreadTest, ARodResistsTurningHalfAsMuchAsItsEnds) {
  Union rod;
  rod.parts.push_back({Capsule{0.004, 0.2}, At(0, 0, 0, Vector3(0, 90, 0))});
  EXPECT_NEAR(MeasureArm(rod, 0.004, false), 0.1, 5e-4);
  EXPECT_NEAR(MeasureArm(rod, 0.004, true), 0.05, 2.5e-4);
}

TEST(SpreadTest, ADiscResistsTurningWithTwoThirdsOfItsRadius) {
  const Cylinder disc{0.05, 0.01};
  EXPECT_NEAR(MeasureArm(disc, 0.005, false), 0.05, 2.5e-4);
  EXPECT_NEAR(MeasureArm(disc, 0.005, true), 0.05 * 2.0 / 3.0, 2e-4);
  // The same on a cylinder wider and narrower than itself, where other code finds the points.
  const auto on = [&](double radius, double smaller) {
    const Body stand = MakeFixed("stand", Cylinder{radius, 0.04}, At(0, 0, -0.02), 0.5);
    EXPECT_NEAR(MeasureArm(disc, 0.005, true, {stand}), smaller * 2.0 / 3.0, 1e-3 * smaller);
  };
  on(0.08, 0.05);
  on(0.03, 0.03);
}

TEST(SpreadTest, APolygonOfManyCornersResistsTurningNearlyLikeTheDiscAroundIt) {
  Rng rng(1);
  MatrixX3 P(48, 3);
  for (int i = 0; i < 48; ++i) {
    const double angle = 2.0 * kPi * (i / 2) / 24;
    P.row(i) << 0.05 * std::cos(angle), 0.05 * std::sin(angle), i % 2 == 0 ? 0.0 : 0.01;
  }
  const Shape prism = testing::MakeMesh(CalcConvexHull(P));
  EXPECT_NEAR(MeasureArm(prism, 0.0, true), 0.05 * 2.0 / 3.0, 0.01 * 0.05);
}

TEST(SpreadTest, ABodyThatSlidesWithItsWeightOffCentreIsNotTurnedByItsFriction) {
  Body box = MakeBox("box", Vector3(0.2, 0.1, 0.02), At(0, 0, 0.01), kMass, kFriction);
  box.mass_properties->p_BoBcm = Vector3(0.03, 0.03, -0.0099);
  StepConfig config;
  config.spread_support = true;
  const World world(MakeScene(box), config);
  WorldState state = world.InitialState();
  Simulate(world, 0.2, &state);
  state.bodies[0].v_WB.x() = 1.0;
  Simulate(world, 0.2, &state);
  EXPECT_GT(state.bodies[0].p_WB.x(), 0.1);
  EXPECT_LT(state.bodies[0].q_WB.vec().norm(), 1e-3);
  // It slows as without the spread.
  EXPECT_NEAR(state.bodies[0].v_WB.x(), 1.0 - 0.2 * kFriction * kGravity, 2e-3);
}

TEST(SpreadTest, StepAgreesWithSimbodyTo1em12WithSpreadSupport) {
  StepConfig config;
  config.spread_support = true;
  const World world(MakeScene(MakeBox("box", Vector3(0.1, 0.08, 0.06), At(0, 0, 0.03), 0.4, 0.4),
                              {MakeTable(), MakeMovable("can", Cylinder{0.03, 0.1},
                                                        At(0.085, 0.01, 0.05), 0.3, 0.4)}),
                    config);
  WorldState state = world.InitialState();
  state.bodies[0].w_WB.z() = 5.0;
  world.PutFinger(state, Finger::kIndex, Vector3(-0.05, 0.02, 0.0));
  state.fingers[kIndex].p_WTarget += Vector3(0.1, 0.02, 0.0);
  for (int block = 0; block < 10; ++block) {
    WorldState oracle = state;
    for (int i = 0; i < 10; ++i) {
      world.Step(state);
      world.StepWithSimbody(oracle);
      for (int b = 0; b < 2; ++b) {
        EXPECT_LT((state.bodies[b].p_WB - oracle.bodies[b].p_WB).norm(), 1e-12);
        EXPECT_LT((state.bodies[b].v_WB - oracle.bodies[b].v_WB).norm(), 2e-12);
        EXPECT_LT((state.bodies[b].w_WB - oracle.bodies[b].w_WB).norm(), 1e-11);
      }
    }
  }
  EXPECT_GT(state.bodies[1].p_WB.x(), 0.09) << "the can is not pushed";
}

TEST(SpreadTest, TheMeanDistanceFromTheCentreIsThatOfSamples) {
  Rng rng(7);
  for (int trial = 0; trial < 5; ++trial) {
    std::vector<Vector2> corners;
    for (int i = 0; i < 7; ++i) {
      corners.push_back({0.3 + 0.1 * rng.Uniform(), 0.05 * rng.Uniform() - 0.2});
    }
    // Points of the hull: random means of the corners do not fill it evenly, so a grid is cut out.
    const auto inside = [&](const Vector2& p) {
      for (std::size_t i = 0; i < corners.size(); ++i) {
        for (std::size_t j = 0; j < corners.size(); ++j) {
          const Vector2 d = corners[j] - corners[i];
          const auto side = [&](const Vector2& q) {
            return d.x() * (q.y() - corners[i].y()) - d.y() * (q.x() - corners[i].x());
          };
          bool is_edge = i != j;
          for (const Vector2& q : corners) is_edge = is_edge && side(q) >= -1e-15;
          if (is_edge && side(p) < 0.0) return false;
        }
      }
      return true;
    };
    std::vector<Vector2> samples;
    Vector2 mean = Vector2::Zero();
    for (int i = 0; i < 400; ++i) {
      for (int j = 0; j < 200; ++j) {
        const Vector2 p(0.3 + 0.1 * (i + 0.5) / 400, -0.2 + 0.05 * (j + 0.5) / 200);
        if (!inside(p)) continue;
        samples.push_back(p);
        mean += p;
      }
    }
    mean /= static_cast<double>(samples.size());
    double distance = 0.0;
    for (const Vector2& p : samples) distance += (p - mean).norm();
    distance /= static_cast<double>(samples.size());
    EXPECT_NEAR(CalcMeanDistance(corners), distance, 2e-3 * distance);
  }
  EXPECT_NEAR(CalcMeanDistance({{0.1, 0.1}, {0.1, 0.5}}), 0.1, 1e-12);
}

}  // namespace
}  // namespace pregrasp
