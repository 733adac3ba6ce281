#include "app/grasp/lift_way.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/grasp/grasp_scenes.h"

namespace pregrasp {
namespace {

std::vector<RigidTransform> PosesOf(const Scene& scene) {
  std::vector<RigidTransform> X_WB;
  for (const Body& body : scene.bodies) X_WB.push_back(body.X_WB);
  return X_WB;
}

LiftWay FindWay(const Scene& scene, int points = 512, const LiftWayConfig& config = {}) {
  const PointCloud cloud = SamplePointCloud(scene.object().shape, points, Rng(1, RngStream::kTest));
  return FindLiftWay(PosesOf(scene), cloud, EnvironmentDistance(scene), Vector3::UnitZ(), config);
}

Scene BoxOnTable() {
  Scene scene = MakeScene("box", Box{{0.05, 0.06, 0.12}}, 0.2, Shift(0, 0, 0.06));
  scene.bodies.push_back(FixedBox("table", {0.8, 0.8, 0.02}, {0, 0, -0.01}));
  return scene;
}

double TiltDeg(const LiftWay& way) { return RadToDeg(std::acos(way.direction_W.z())); }

TEST(LiftWayTest, IsTenCentimetresUpWhereThatIsFree) {
  const LiftWay way = FindWay(BoxOnTable());
  EXPECT_TRUE(way.is_free());
  EXPECT_TRUE(way.direction_W.isApprox(Vector3::UnitZ(), 1e-12));
  EXPECT_EQ(way.length, 0.10);
  EXPECT_EQ(way.rise_W, Vector3::Zero());
}

TEST(LiftWayTest, PassesAnEdgeAtTheSteepestAngleToADegree) {
  // A ball of radius r under a board whose edge is e aside and h above the ball's centre: moving at
  // angle a to the vertical it keeps clear of the edge if h sin a - e cos a >= r.
  const double r = 0.02, e = 0.03, h = 0.06;
  Scene scene = MakeScene("ball", Sphere{r}, 0.05, Shift(0, 0, r));
  scene.bodies.push_back(FixedBox("table", {2, 2, 0.02}, {0, 0, -0.01}));
  scene.bodies.push_back(FixedBox("board", {2, 2, 0.5}, {e - 1.0, 0, r + h + 0.25}));
  double expected = 0.0;
  while (h * std::sin(expected) - e * std::cos(expected) < r - 1e-3) expected += 1e-4;
  const LiftWay way = FindWay(scene, 2048);
  ASSERT_TRUE(way.is_free());
  EXPECT_NEAR(TiltDeg(way), RadToDeg(expected), 1.0);
  EXPECT_GT(way.direction_W.x(), 0.0);
  EXPECT_NEAR(way.direction_W.y(), 0.0, 0.02);
}

TEST(LiftWayTest, GoesOnUntilTheObjectIsOutAndThenUp) {
  // A book between two others and a board: 15.5 cm deep, so that 10 cm leave it between them.
  const Scene scene = BookScene();
  const LiftWay way = FindWay(scene);
  ASSERT_TRUE(way.is_free());
  EXPECT_GT(TiltDeg(way), 45.0);
  const Vector3 out = way.length * way.direction_W;
  EXPECT_GT(out.x(), 0.15);
  EXPECT_LT(out.x(), 0.18);
  EXPECT_EQ(way.rise_W, Vector3(0, 0, 0.02));
  // Nothing of it is then nearer than 5 mm to anything.
  const PointCloud cloud = SamplePointCloud(scene.object().shape, 512, Rng(2, RngStream::kTest));
  const EnvironmentDistance environment(scene);
  for (Eigen::Index i = 0; i < cloud.P.rows(); ++i) {
    const Vector3 p_W = scene.object().X_WB * Vector3(cloud.P.row(i)) + out + way.rise_W;
    EXPECT_GT(environment.Calc(p_W).phi, 4e-3);
  }
}

TEST(LiftWayTest, StraightUpGoesOnUntilTheObjectIsAboveItsNeighbours) {
  Scene scene = BoxOnTable();
  for (const double side : {-1.0, 1.0}) {
    const std::string name = side < 0 ? "right" : "left";
    scene.bodies.push_back(FixedBox(name, {0.05, 0.06, 0.15}, {0, side * 0.062, 0.075}));
  }
  const LiftWay way = FindWay(scene);
  ASSERT_TRUE(way.is_free());
  EXPECT_EQ(TiltDeg(way), 0.0);
  EXPECT_EQ(way.rise_W, Vector3::Zero());
  // Its underside 5 mm above their tops, to a step of the length.
  EXPECT_GE(way.length, 0.15 + 0.0049);
  EXPECT_LE(way.length, 0.15 + 0.0111);
}

TEST(LiftWayTest, UnderACeilingThatKeepsTheObjectAmongNeighboursStraightUpIsAsFarAsIsAsked) {
  Scene scene = BoxOnTable();
  for (const double side : {-1.0, 1.0}) {
    const std::string name = side < 0 ? "right" : "left";
    scene.bodies.push_back(FixedBox(name, {0.05, 0.06, 0.15}, {0, side * 0.062, 0.075}));
  }
  scene.bodies.push_back(FixedBox("ceiling", {0.8, 0.8, 0.02}, {0, 0, 0.12 + 0.12 + 0.01}));
  const LiftWay way = FindWay(scene);
  ASSERT_TRUE(way.is_free());
  EXPECT_EQ(TiltDeg(way), 0.0);
  EXPECT_EQ(way.length, 0.10);
}

TEST(LiftWayTest, InAClosedRoomThereIsNone) {
  Scene scene = BoxOnTable();
  for (const double side : {-1.0, 1.0}) {
    scene.bodies.push_back(FixedBox(side < 0 ? "back" : "front", {0.02, 0.4, 0.4},
                                    {side * (0.025 + 0.02 + 0.01), 0, 0.2}));
    scene.bodies.push_back(FixedBox(side < 0 ? "right" : "left", {0.4, 0.02, 0.4},
                                    {0, side * (0.03 + 0.02 + 0.01), 0.2}));
  }
  scene.bodies.push_back(FixedBox("lid", {0.4, 0.4, 0.02}, {0, 0, 0.12 + 0.02 + 0.01}));
  EXPECT_EQ(FindWay(scene).status, LiftWayStatus::kNoFreeDirection);
  scene.bodies.pop_back();
  EXPECT_TRUE(FindWay(scene).is_free());
}

TEST(LiftWayTest, InATunnelLongerThanTheReachTheObjectNeverComesFree) {
  const auto in_tunnel = [](double length) {
    Scene scene = MakeScene("bar", Box{{0.10, 0.03, 0.03}}, 0.1, Shift(0, 0, 0.015));
    scene.bodies.push_back(FixedBox("floor", {2 * length, 0.1, 0.02}, {0, 0, -0.01}));
    scene.bodies.push_back(FixedBox("left", {2 * length, 0.02, 0.05}, {0, 0.026, 0.025}));
    scene.bodies.push_back(FixedBox("right", {2 * length, 0.02, 0.05}, {0, -0.026, 0.025}));
    scene.bodies.push_back(FixedBox("roof", {2 * length, 0.1, 0.02}, {0, 0, 0.032 + 0.01}));
    return scene;
  };
  EXPECT_EQ(FindWay(in_tunnel(1.0)).status, LiftWayStatus::kNeverFree);
  const LiftWay way = FindWay(in_tunnel(0.3));
  ASSERT_TRUE(way.is_free());
  EXPECT_NEAR(way.length, 0.3 + 0.05, 0.02);
}

}  // namespace
}  // namespace pregrasp
