#include "app/studies/ladder_oracle.h"

#include <gtest/gtest.h>

namespace pregrasp {
namespace {

RigidTransform Pose(double x, double turn) {
  return MakeTransform(Quaternion(Eigen::AngleAxisd(turn, Vector3::UnitY())), Vector3(x, 0, 0));
}

// 10 cm straight on, then half a radian about y; with a radius of 0.2 m both are 10 cm.
LadderProgress TwoLegs() {
  return {{{Pose(0, 0), {}}, {Pose(0.1, 0), {}}, {Pose(0.1, 0.5), {}}}, 0.2};
}

TEST(LadderProgressTest, IsTheShareOfTheWay) {
  const LadderProgress progress = TwoLegs();
  EXPECT_NEAR(progress.Calc(Pose(0, 0)), 0.0, 1e-12);
  EXPECT_NEAR(progress.Calc(Pose(0.05, 0)), 0.25, 1e-12);
  EXPECT_NEAR(progress.Calc(Pose(0.1, 0)), 0.5, 1e-12);
  EXPECT_NEAR(progress.Calc(Pose(0.1, 0.25)), 0.75, 1e-9);
  EXPECT_NEAR(progress.Calc(Pose(0.1, 0.5)), 1.0, 1e-9);
}

TEST(LadderProgressTest, FallsBesideTheWayAndBeyondItsEnd) {
  const LadderProgress progress = TwoLegs();
  RigidTransform beside = Pose(0.1, 0.25);
  beside.translation().y() = 0.02;
  EXPECT_LT(progress.Calc(beside), progress.Calc(Pose(0.1, 0.25)));
  EXPECT_LT(progress.Calc(Pose(0.1, 0.8)), 1.0);
  EXPECT_EQ(progress.Calc(Pose(-0.3, 0)), 0.0);
}

TEST(LadderOracleTest, ScoresTheObjectsPoseWhateverTheContacts) {
  const LadderOracle oracle(TwoLegs());
  ScoredState state{{Pose(0.05, 0), Pose(9, 9)}, {}};
  ScoredState pressed = state;
  pressed.placement.fingers[1].on = true;
  const std::vector<ScoredState> states = {state, pressed};
  const std::vector<double> scores = oracle.Score(states);
  EXPECT_NEAR(scores[0], 0.25, 1e-12);
  EXPECT_EQ(scores[0], scores[1]);
  EXPECT_EQ(oracle.ScoreGraspable(states), scores);
}

}  // namespace
}  // namespace pregrasp
