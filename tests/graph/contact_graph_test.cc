#include "app/graph/contact_graph.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <tuple>

#include "app/core/error.h"
#include "tests/graph/graph_fixture.h"

namespace pregrasp {
namespace {

ContactGraph MakeScored(double top_percent, std::uint64_t seed = 1) {
  ContactGraphConfig config;
  config.top_percent = top_percent;
  ContactGraph graph(MakeBoxMesh(kBoxSize), config);
  graph.Score(SignedDistance(Box{kBoxSize}), AnalyticScorer(3.0, -0.02), AnalyticScorer(50.0),
              seed);
  return graph;
}

TEST(ContactGraphTest, NodesAreAllOrderedPairsOfTrianglesWithStableIds) {
  const ContactGraph graph(MakeBoxMesh(kBoxSize), {});
  ASSERT_EQ(graph.nodes().size(), 144U);
  for (int id = 0; id < 144; ++id) {
    EXPECT_EQ(graph.nodes()[id].id, id);
    EXPECT_EQ(graph.nodes()[id].thumb, id / 12);
    EXPECT_EQ(graph.nodes()[id].index, id % 12);
  }
}

TEST(ContactGraphTest, KeepsTheTopPercentByEitherScoreAndSaysWhy) {
  ContactGraph graph = MakeScored(10.0);
  graph.Prune();
  const int each = 15;  // 10 % of 144, rounded up
  int initial = 0;
  for (const ContactNode& node : graph.nodes()) {
    int better_c = 0, better_n = 0;
    for (const ContactNode& other : graph.nodes()) {
      better_c +=
          std::tuple(-other.s_c, -other.s_n, other.id) < std::tuple(-node.s_c, -node.s_n, node.id);
      better_n +=
          std::tuple(-other.s_n, -other.s_c, other.id) < std::tuple(-node.s_n, -node.s_c, node.id);
    }
    EXPECT_EQ(node.rank_c, better_c + 1);
    EXPECT_EQ(node.rank_n, better_n + 1);
    EXPECT_EQ(node.initial, better_c < each);
    EXPECT_EQ(node.kept, better_c < each || better_n < each);
    initial += node.initial;

    const NodeReason reason = graph.Why(node.id);
    EXPECT_EQ(reason.verdict == NodeReason::Verdict::kPruned, !node.kept);
    EXPECT_EQ(node.s_c >= reason.threshold_c || node.s_n >= reason.threshold_n, node.kept);
  }
  EXPECT_EQ(initial, each);
}

TEST(ContactGraphTest, WhereTheCutGoesThroughEqualScoresTheOtherScoreDecidesAndTheReasonSaysSo) {
  // 12 nodes an index triangle, all with one s_c; the best 20 of 144 are one group and 8 of
  // another.
  ContactGraph graph = MakeScoredGraph(NoThumbScorer(3.0), AnalyticScorer(50.0), 13.8);
  graph.Prune();
  double worst_kept = 1.0, best_pruned = 0.0;
  int tied = 0, tied_kept = 0;
  for (const ContactNode& node : graph.nodes()) {
    const NodeReason reason = graph.Why(node.id);
    ASSERT_EQ(reason.num_kept_each, 20);
    EXPECT_EQ(reason.num_tied_c, 12);
    EXPECT_EQ(reason.num_tied_n, 1);
    EXPECT_EQ(reason.rule_n, TieRule::kNone);
    const bool at_threshold = node.s_c == reason.threshold_c;
    EXPECT_EQ(reason.rule_c, at_threshold ? TieRule::kScores : TieRule::kNone) << node.id;
    if (!at_threshold) continue;
    ++tied;
    tied_kept += node.initial;
    if (node.initial) worst_kept = std::min(worst_kept, node.s_n);
    if (!node.initial) best_pruned = std::max(best_pruned, node.s_n);
  }
  EXPECT_EQ(tied, 12);
  EXPECT_EQ(tied_kept, 8);
  EXPECT_GT(worst_kept, best_pruned);
}

TEST(ContactGraphTest, ScoresThatWereRecordedGiveTheSameGraphAndTheSameReasons) {
  ContactGraph graph = MakeScoredGraph(NoThumbScorer(3.0), AnalyticScorer(50.0), 13.8);
  ContactGraph::Scores scores;
  for (const ContactNode& node : graph.nodes()) {
    scores.s_c.push_back(node.s_c);
    scores.s_n.push_back(node.s_n);
    scores.occluded.push_back(node.occluded);
  }
  ContactGraph again(graph.mesh(), graph.config());
  again.TakeScores(scores);
  for (ContactGraph* each : {&graph, &again}) each->Prune();
  EXPECT_EQ(again.kept(), graph.kept());
  for (const ContactNode& node : graph.nodes()) {
    const NodeReason a = graph.Why(node.id), b = again.Why(node.id);
    EXPECT_EQ(a.verdict, b.verdict);
    EXPECT_EQ(a.node.rank_c, b.node.rank_c);
    EXPECT_EQ(a.node.rank_n, b.node.rank_n);
    EXPECT_EQ(a.rule_c, b.rule_c);
    EXPECT_EQ(a.node.occluded, b.node.occluded);
  }
  scores.s_n.pop_back();
  EXPECT_THROW(again.TakeScores(scores), InputError);
}

TEST(ContactGraphTest, NodesAlikeInBothScoresStayByNumberAndTheReasonSaysSo) {
  ContactGraph graph = MakeScoredGraph(ConstantScorer(), ConstantScorer(), 10.0);
  graph.Prune();
  for (const ContactNode& node : graph.nodes()) {
    EXPECT_EQ(node.initial, node.id < 15);
    const NodeReason reason = graph.Why(node.id);
    EXPECT_EQ(reason.rule_c, TieRule::kNumber);
    EXPECT_EQ(reason.rule_n, TieRule::kNumber);
    EXPECT_EQ(reason.num_tied_c, 144);
    EXPECT_EQ(reason.num_tied_n, 144);
  }
}

TEST(ContactGraphTest, NoNodeIsCalledKeptOrPrunedBeforeThePruningHasDecidedOnIt) {
  using Verdict = NodeReason::Verdict;
  ContactGraph graph = MakeScored(10.0);
  const auto count = [&](Verdict verdict) {
    int found = 0;
    for (const ContactNode& node : graph.nodes()) found += graph.Why(node.id).verdict == verdict;
    return found;
  };
  EXPECT_EQ(count(Verdict::kScored), 144);
  graph.PruneStep(4);  // of the 15 best by s_c
  EXPECT_EQ(count(Verdict::kKeptByContext), 4);
  EXPECT_EQ(count(Verdict::kScored), 140);
  graph.PruneStep();
  EXPECT_EQ(count(Verdict::kKeptByContext), 15);
  EXPECT_EQ(count(Verdict::kScored), 129);
  graph.PruneStep(1);  // of the 15 best by s_n
  EXPECT_EQ(count(Verdict::kKeptByFree) + count(Verdict::kKeptByBoth), 1);
  EXPECT_EQ(count(Verdict::kPruned), 0);
  graph.PruneStep();
  EXPECT_EQ(count(Verdict::kScored), 0);
  EXPECT_EQ(count(Verdict::kPruned), 144 - static_cast<int>(graph.kept().size()));
}

TEST(ContactGraphTest, EdgesJoinKeptNodesThatShareATriangleAndEachWithItself) {
  ContactGraph graph = MakeScored(20.0);
  graph.Prune();
  std::set<std::pair<int, int>> edges;
  for (const int a : graph.kept()) {
    for (const int b : graph.neighbors(a)) {
      EXPECT_TRUE(graph.nodes()[a].thumb == graph.nodes()[b].thumb ||
                  graph.nodes()[a].index == graph.nodes()[b].index);
      const auto& back = graph.neighbors(b);
      EXPECT_TRUE(std::find(back.begin(), back.end(), a) != back.end());
      edges.insert(std::minmax(a, b));
    }
    EXPECT_TRUE(edges.count({a, a}));
  }
  EXPECT_EQ(graph.num_edges(), static_cast<int>(edges.size()));
}

TEST(ContactGraphTest, APairOfTipsThatOverlapIsWorthNothing) {
  // Every placement scores 1/2. On a cube of 5 mm no two places on one face leave room for two
  // tips, and all on opposite faces do.
  class Half : public PlacementScorer {
   public:
    std::vector<double> Score(std::span<const Placement> placements) const override {
      return std::vector<double>(placements.size(), 0.5);
    }
    bool IsOccluded(Finger, const Placement::Contact&) const override { return false; }
  };
  const Vector3 size(0.005, 0.005, 0.005);
  ContactGraph graph(MakeBoxMesh(size), {});
  graph.Score(SignedDistance(Box{size}), Half(), Half(), 1);
  const auto s_n = [&](int thumb, int index) { return graph.nodes().at(12 * thumb + index).s_n; };
  EXPECT_NEAR(s_n(0, 0), 0.5 * 2.0 / 3.0, 1e-12);  // both on the bottom
  EXPECT_NEAR(s_n(0, 1), 0.5 * 2.0 / 3.0, 1e-12);
  EXPECT_NEAR(s_n(0, 2), 0.5, 1e-12);  // bottom and top
}

TEST(ContactGraphTest, AnOccludedPlacementIsWorthNothingInContext) {
  ContactGraphConfig config;
  ContactGraph graph(MakeBoxMesh(kBoxSize), config);
  graph.Score(SignedDistance(Box{kBoxSize}), AnalyticScorer(3.0, 1.0), AnalyticScorer(3.0), 1);
  for (const ContactNode& node : graph.nodes()) {
    EXPECT_EQ(node.s_c, 0.0);
    EXPECT_EQ(node.occluded, 1.0);
    EXPECT_GT(node.s_n, 0.0);
  }
}

TEST(ContactGraphTest, TheSameSeedGivesTheSameScoresAndAnotherSeedOthers) {
  const ContactGraph a = MakeScored(5.0, 1), b = MakeScored(5.0, 1), c = MakeScored(5.0, 2);
  int different = 0;
  for (int id = 0; id < 144; ++id) {
    EXPECT_EQ(a.nodes()[id].s_c, b.nodes()[id].s_c);
    EXPECT_EQ(a.nodes()[id].s_n, b.nodes()[id].s_n);
    different += a.nodes()[id].s_n != c.nodes()[id].s_n;
  }
  EXPECT_GT(different, 100);
}

TEST(ContactGraphTest, PruningStepByStepEqualsPruningAtOnce) {
  ContactGraph once = MakeScored(10.0);
  ContactGraph steps = once;
  once.Prune();
  steps.PruneStep();
  const ContactGraph earlier = steps;
  steps.PruneStep();
  steps.PruneStep();
  EXPECT_EQ(once.kept(), steps.kept());
  EXPECT_EQ(once.num_edges(), steps.num_edges());
  EXPECT_EQ(earlier.stage(), GraphStage::kPrunedContext);
}

TEST(ContactGraphTest, AnotherPercentageCountsUntilPruningBegins) {
  ContactGraph graph = MakeScored(10.0);
  graph.SetTopPercent(50.0);
  graph.Prune();
  EXPECT_EQ(graph.Why(0).num_kept_each, static_cast<int>(graph.nodes().size()) / 2);
  EXPECT_THROW(graph.SetTopPercent(5.0), InputError);
  EXPECT_THROW(MakeScored(10.0).SetTopPercent(0.0), InternalError);
}

TEST(ContactGraphTest, AConfigurationThatNoSettingGivesIsOurBugAndAnUnknownIdBadInput) {
  for (const double top_percent : {0.0, 101.0, std::numeric_limits<double>::quiet_NaN()}) {
    ContactGraphConfig config;
    config.top_percent = top_percent;
    EXPECT_THROW(ContactGraph(MakeBoxMesh(kBoxSize), config), InternalError) << top_percent;
  }
  ContactGraph graph(MakeBoxMesh(kBoxSize), {});
  EXPECT_THROW(graph.Prune(), InputError);
  EXPECT_THROW(graph.Why(144), InputError);
}

}  // namespace
}  // namespace pregrasp
