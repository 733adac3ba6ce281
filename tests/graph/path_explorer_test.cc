#include "app/graph/path_explorer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "app/core/error.h"
#include "tests/graph/graph_fixture.h"

namespace pregrasp {
namespace {

// Nothing can touch below z = -0.02: the bottom of the box and the lower ends of its sides.
ContactGraph MakeExploredGraph(std::uint64_t seed) {
  ContactGraphConfig config;
  config.top_percent = 6.0;
  ContactGraph graph(MakeBoxMesh(kBoxSize), config);
  graph.Score(SignedDistance(Box{kBoxSize}), AnalyticScorer(3.0, -0.02), AnalyticScorer(50.0),
              seed);
  graph.Prune();
  return graph;
}

std::vector<ContactPath> ListPaths(const ContactGraph& graph, int stages) {
  PathExplorer explorer(graph, stages);
  std::vector<ContactPath> paths;
  for (ContactPath path; explorer.Next(&path);) paths.push_back(path);
  return paths;
}

TEST(PathExplorerTest, NoPathBeginsWhereNoFingertipFitsAndEveryOtherNodeBeginsOne) {
  const ContactGraph graph = MakeExploredGraph(1);
  std::set<int> first;
  for (const ContactPath& path : ListPaths(graph, 2)) first.insert(path.nodes.front());
  int fitting = 0;
  for (const ContactNode& node : graph.nodes()) {
    const bool fits = node.thumb_fits || node.index_fits;
    EXPECT_EQ(first.count(node.id), fits ? 1U : 0U) << node.id;
    fitting += fits;
  }
  EXPECT_EQ(PathExplorer(graph, 2).num_paths(), fitting);
  // Triangles 0 and 1 are the bottom.
  EXPECT_LT(fitting, static_cast<int>(graph.nodes().size()));
  EXPECT_FALSE(graph.nodes()[0].thumb_fits);
  EXPECT_EQ(first.count(1), 0U);
}

TEST(PathExplorerTest, TheFirstPathBeginsWithTheBestNodeAndTenPushAtMorePlacesThanThePapers) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const ContactGraph graph = MakeExploredGraph(seed);
    const std::vector<ContactPath> paths = ListPaths(graph, 2);
    double best = 0.0;
    for (const ContactNode& node : graph.nodes()) best = std::max(best, node.s_c);
    EXPECT_EQ(graph.nodes()[paths[0].nodes[0]].s_c, best);
    EXPECT_EQ(paths[0].repeats, 0.0);
    std::set<int> explored, papers;
    PathSearch search(graph, 2);
    for (int i = 0; i < 8; ++i) {
      ContactPath path;
      ASSERT_TRUE(search.Next(&path));
      papers.insert(graph.nodes()[path.nodes[0]].thumb);
      explored.insert(graph.nodes()[paths[i].nodes[0]].thumb);
    }
    EXPECT_GT(explored.size(), papers.size()) << seed;
    EXPECT_GE(explored.size(), 6U) << seed;
  }
}

// By the header's words, from the paths before alone.
double CountRepeats(const ContactGraph& graph, const std::vector<ContactPath>& paths, int until) {
  // Two triangles a side, in the order of MakeBoxMesh.
  const auto side = [](int triangle) { return triangle / 2; };
  const ContactNode& node = graph.nodes()[paths[until].nodes[0]];
  double repeats = 0.0;
  for (int i = 0; i < until; ++i) {
    const ContactNode& other = graph.nodes()[paths[i].nodes[0]];
    if (node.thumb_fits && other.thumb_fits) {
      repeats += other.thumb == node.thumb;
      repeats += side(other.thumb) == side(node.thumb) ? 0.5 : 0.0;
    }
    if (node.index_fits && other.index_fits) {
      repeats += other.index == node.index;
      repeats += side(other.index) == side(node.index) ? 0.5 : 0.0;
    }
  }
  return repeats;
}

TEST(PathExplorerTest, ValuesAreScoresOverWhatPathsBeforeHaveTriedAndNeverRise) {
  const ContactGraph graph = MakeExploredGraph(2);
  const std::vector<ContactPath> paths = ListPaths(graph, 2);
  double best = 0.0;
  for (const ContactNode& node : graph.nodes()) best = std::max(best, node.s_c);
  for (int i = 0; i < 30; ++i) {
    const ContactPath& path = paths[i];
    EXPECT_EQ(path.rank, i + 1);
    EXPECT_EQ(path.repeats, CountRepeats(graph, paths, i)) << i;
    const double share = graph.nodes()[path.nodes[0]].s_c / best;
    EXPECT_NEAR(path.value, std::max(PathExplorer::kLeastScore, share) / (1.0 + path.repeats),
                1e-12);
    if (i > 0) {
      EXPECT_LE(path.value, paths[i - 1].value);
    }
  }
}

TEST(PathExplorerTest, ALaterNodeSharesATriangleAndOnesThatATipFitsComeFirst) {
  const ContactGraph graph = MakeExploredGraph(3);
  for (const ContactPath& path : ListPaths(graph, 3)) {
    ASSERT_EQ(path.nodes.size(), 3U);
    for (int stage = 1; stage < 3; ++stage) {
      const ContactNode& before = graph.nodes()[path.nodes[stage - 1]];
      const ContactNode& node = graph.nodes()[path.nodes[stage]];
      EXPECT_TRUE(node.thumb == before.thumb || node.index == before.index);
      EXPECT_TRUE(node.kept || node.id == before.id);
      EXPECT_TRUE(node.thumb_fits || node.index_fits);  // the node itself would do
    }
  }
}

TEST(PathExplorerTest, TiesAreCountedAndGoByRank) {
  ContactGraph graph = MakeScoredGraph(ConstantScorer(), ConstantScorer(), 8.0);
  graph.Prune();
  const std::vector<ContactPath> paths = ListPaths(graph, 2);
  EXPECT_EQ(paths[0].num_tied, static_cast<int>(graph.nodes().size()));
  EXPECT_EQ(paths[0].rule, TieRule::kNumber);
  EXPECT_EQ(graph.nodes()[paths[0].nodes[0]].rank_c, 1);
}

TEST(PathExplorerTest, ACopyGoesOnFromWhereItWasTaken) {
  ExpectCopyGoesOn(PathExplorer(MakeExploredGraph(4), 2));
}

TEST(PathExplorerTest, NeedsAPrunedGraph) {
  EXPECT_THROW(PathExplorer(ContactGraph(MakeBoxMesh(kBoxSize), {}), 2), InputError);
}

}  // namespace
}  // namespace pregrasp
