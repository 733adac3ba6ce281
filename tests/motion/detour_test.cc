#include "app/motion/detour.h"

#include <gtest/gtest.h>

#include "app/hand/hand_kinematics.h"

namespace pregrasp {
namespace {

RigidTransform PoseAt(const Vector3& p) { return MakeTransform(Quaternion::Identity(), p); }

// A ball far away and a wall in the plane x = 0, half a metre wide and high.
class DetourTest : public ::testing::Test {
 protected:
  static HandConfiguration HandIn(double x) {
    HandConfiguration hand;
    hand.X_WH.translation() << x, 0.0, 0.0;
    hand.q = ShadowHand().posture;
    return hand;
  }

  DetourProblem Across() const {
    DetourProblem problem;
    problem.from = HandIn(-0.15);
    problem.to = HandIn(0.15);
    problem.X_WB = {PoseAt({0.0, 0.0, 3.0}), PoseAt({0.0, 0.0, 0.0})};
    return problem;
  }

  DetourResult Find(const IkSolver& solver, const DetourProblem& problem, int number = 0) const {
    DetourConfig config;
    config.spread = 0.4;
    return FindDetour(solver, {}, config, problem, Rng(1, RngStream::kTest, number));
  }

  bool IsClear(const IkSolver& solver, const DetourProblem& problem,
               const DetourResult& result) const {
    for (std::size_t i = 1; i < result.points.size(); ++i) {
      HandWay way;
      way.from = result.points[i - 1];
      way.to = result.points[i];
      way.X_WB = {problem.X_WB};
      if (!solver.CheckWay(way).clear) return false;
    }
    return true;
  }

  const Shape ball_{Sphere{0.03}}, wall_{Box{{0.01, 0.5, 0.5}}}, hall_{Box{{0.01, 20.0, 20.0}}};
  const IkSolver around_{ShadowHand(), std::vector<const Shape*>{&ball_, &wall_}};
  const IkSolver closed_{ShadowHand(), std::vector<const Shape*>{&ball_, &hall_}};
};

TEST_F(DetourTest, AFreeWayIsTheStraightOne) {
  DetourProblem problem = Across();
  problem.to = HandIn(-0.35);
  const DetourResult result = Find(around_, problem);
  EXPECT_EQ(result.kind, DetourKind::kStraight);
  ASSERT_EQ(result.points.size(), 2U);
  EXPECT_EQ(result.points[1].X_WH.translation(), problem.to.X_WH.translation());
}

TEST_F(DetourTest, AWallIsGoneRoundForEverySeed) {
  const DetourProblem problem = Across();
  for (int seed = 0; seed < 5; ++seed) {
    const DetourResult result = Find(around_, problem, seed);
    EXPECT_EQ(result.kind, DetourKind::kSearch) << seed;
    EXPECT_TRUE(IsClear(around_, problem, result)) << seed;
    EXPECT_EQ(result.points.front().q, problem.from.q);
    EXPECT_EQ(result.points.back().q, problem.to.q);
    for (const HandConfiguration& point : result.points) {
      EXPECT_TRUE((point.q.array() >= ShadowHand().q_lower.array()).all());
      EXPECT_TRUE((point.q.array() <= ShadowHand().q_upper.array()).all());
    }
  }
}

TEST_F(DetourTest, WhereThereIsNoWayItSaysSoAndReturnsOneThatIsNotFree) {
  const DetourResult result = Find(closed_, Across());
  EXPECT_EQ(result.kind, DetourKind::kBlocked);
  EXPECT_EQ(result.tries, DetourConfig().max_tries);
  EXPECT_FALSE(IsClear(closed_, Across(), result));
}

TEST_F(DetourTest, TheSameArgumentsGiveTheSameBits) {
  const DetourResult a = Find(around_, Across()), b = Find(around_, Across());
  ASSERT_EQ(a.points.size(), b.points.size());
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    EXPECT_EQ(a.points[i].X_WH.matrix(), b.points[i].X_WH.matrix());
    EXPECT_EQ(a.points[i].q, b.points[i].q);
  }
}

}  // namespace
}  // namespace pregrasp
