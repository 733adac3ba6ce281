#include "app/graph/learned_scorer.h"

#include <gtest/gtest.h>

#include "tests/networks/random_network.h"

namespace pregrasp {
namespace {

const Vector3 kBarSize(0.20, 0.06, 0.02);

// A bar flat on a table, 5 cm of it over the edge at x = 0.
Scene MakeBarScene() {
  Scene scene;
  scene.name = "bar";
  Body bar;
  bar.name = "bar";
  bar.shape = Box{kBarSize};
  bar.mass_properties = MassProperties{0.1, Vector3::Zero(), Matrix3::Identity() * 1e-4};
  bar.X_WB.translation() << -0.05, 0.0, 0.01;
  Body table;
  table.name = "table";
  table.shape = Box{Vector3(0.5, 0.5, 0.1)};
  table.X_WB.translation() << -0.25, 0.0, -0.05;
  scene.bodies = {bar, table};
  return scene;
}

struct BarScorer {
  explicit BarScorer(int threads) : pool(threads) {}
  Scene scene = MakeBarScene();
  ThreadPool pool;
  EnvironmentDistance environment{scene};
  ScoreFunction score = ScoreFunction::FromTensors(MakeRandomScore(3));
  LearnedScorer scorer{score, scene,
                       SamplePointCloud(scene.object().shape, 256, Rng(1, RngStream::kObjectCloud)),
                       environment, pool};
};

Placement PlaceIndex(const Vector3& p_OC) {
  Placement placement;
  placement.fingers[1] = {true, p_OC, Vector3::UnitZ()};
  return placement;
}

TEST(LearnedScorerTest, SeesWhatHidesBelowTheObjectAndWhatStandsOverTheEdge) {
  const BarScorer bar(1);
  const std::vector<RigidTransform> X_WB = {bar.scene.bodies[0].X_WB, bar.scene.bodies[1].X_WB};
  const PointCloud& cloud = bar.scorer.cloud();
  const ObjectState state = MakeObjectState(cloud, X_WB, bar.environment, bar.scene.gravity, 0.009);
  for (Eigen::Index i = 0; i < cloud.P.rows(); ++i) {
    const bool bottom = cloud.N(i, 2) < -0.9;
    const double x = cloud.P(i, 0) - 0.05;
    if (bottom && x < -0.005) {
      EXPECT_TRUE(state.occluded[i]);
    }
    if (bottom && x > 0.010) {
      EXPECT_FALSE(state.occluded[i]);
    }
    if (cloud.N(i, 2) > 0.9) {
      EXPECT_FALSE(state.occluded[i]);
    }
    if (bottom && x < 0.0) {
      EXPECT_NEAR(state.phi[i], 0.0, 1e-9);
    }
  }
  EXPECT_TRUE(state.up_O.isApprox(Vector3::UnitZ(), 1e-12));
}

TEST(LearnedScorerTest, AStateAtTheStartScoresAsItsPlacementInContext) {
  const BarScorer bar(2);
  const auto context = bar.scorer.InContext();
  std::vector<Placement> placements;
  std::vector<ScoredState> states;
  for (const double x : {-0.08, 0.0, 0.08}) {
    placements.push_back(PlaceIndex({x, 0.01, 0.01}));
    states.push_back({{bar.scene.bodies[0].X_WB, bar.scene.bodies[1].X_WB}, placements.back()});
  }
  const auto a = context->Score(placements), b = bar.scorer.Score(states);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-6);
  EXPECT_NE(a[0], a[2]);
}

TEST(LearnedScorerTest, WithoutSurroundingsNothingIsOccludedAndScoresDiffer) {
  const BarScorer bar(1);
  const auto context = bar.scorer.InContext(), free = bar.scorer.Free();
  const Placement::Contact below{true, Vector3(-0.05, 0, -0.01), -Vector3::UnitZ()};
  EXPECT_TRUE(context->IsOccluded(Finger::kIndex, below));
  EXPECT_FALSE(free->IsOccluded(Finger::kIndex, below));
  const std::vector<Placement> placement = {PlaceIndex({0, 0, 0.01})};
  EXPECT_NE(context->Score(placement)[0], free->Score(placement)[0]);
}

TEST(LearnedScorerTest, OneAndThreeThreadsGiveTheSameBits) {
  const BarScorer one(1), three(3);
  std::vector<ScoredState> states;
  Rng rng(9);
  for (int i = 0; i < 40; ++i) {
    RigidTransform X_WO = one.scene.bodies[0].X_WB;
    X_WO.translation().x() += rng.Uniform(0.0, 0.1);
    states.push_back({{X_WO, one.scene.bodies[1].X_WB}, PlaceIndex({0.01, 0, 0.01})});
  }
  EXPECT_EQ(one.scorer.Score(states), three.scorer.Score(states));
}

}  // namespace
}  // namespace pregrasp
