#include "app/graph/contact_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "app/core/error.h"
#include "tests/graph/graph_fixture.h"

namespace pregrasp {
namespace {

ContactGraph MakeGraph(std::uint64_t seed) {
  ContactGraphConfig config;
  config.top_percent = 6.0;
  ContactGraph graph(MakeBoxMesh(kBoxSize), config);
  graph.Score(SignedDistance(Box{kBoxSize}), AnalyticScorer(3.0, -0.02), AnalyticScorer(50.0),
              seed);
  graph.Prune();
  return graph;
}

// Every path of `stages` nodes, by brute force.
void ListAll(const ContactGraph& graph, int stages, std::vector<int>& path, double score,
             std::vector<std::pair<double, std::vector<int>>>& all) {
  if (static_cast<int>(path.size()) == stages) {
    all.emplace_back(score, path);
    return;
  }
  const std::vector<int> next = path.empty() ? graph.kept() : graph.neighbors(path.back());
  for (const int id : next) {
    if (path.empty() && !graph.nodes()[id].initial) continue;
    const double term = path.empty() ? graph.nodes()[id].s_c : graph.nodes()[id].s_n;
    path.push_back(id);
    ListAll(graph, stages, path, score + term, all);
    path.pop_back();
  }
}

TEST(PathSearchTest, GivesEveryPathOnceBestFirst) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    for (const int stages : {1, 2, 3}) {
      const ContactGraph graph = MakeGraph(seed);
      std::vector<std::pair<double, std::vector<int>>> all;
      std::vector<int> scratch;
      ListAll(graph, stages, scratch, 0.0, all);
      std::sort(all.begin(), all.end(), [](auto& a, auto& b) { return a.first > b.first; });
      PathSearch search(graph, stages);
      EXPECT_EQ(search.num_paths(), static_cast<double>(all.size()));
      std::set<std::vector<int>> seen;
      ContactPath path;
      std::size_t count = 0;
      for (; search.Next(&path); ++count) {
        ASSERT_LT(count, all.size());
        EXPECT_NEAR(path.score, all[count].first, 1e-12);
        EXPECT_EQ(path.rank, static_cast<int>(count) + 1);
        EXPECT_NEAR(std::accumulate(path.terms.begin(), path.terms.end(), 0.0), path.score, 1e-12);
        EXPECT_TRUE(seen.insert(path.nodes).second) << "found twice";
      }
      EXPECT_EQ(count, all.size());
    }
  }
}

// Every path of a graph with its score, in the order that the header states, by brute force.
std::vector<ContactPath> ListInOrder(const ContactGraph& graph, int stages) {
  std::vector<std::pair<double, std::vector<int>>> all;
  std::vector<int> scratch;
  ListAll(graph, stages, scratch, 0.0, all);
  std::vector<ContactPath> paths;
  for (const auto& [unused, nodes] : all) {
    ContactPath path;
    path.nodes = nodes;
    for (std::size_t i = nodes.size(); i-- > 0;) {
      const ContactNode& node = graph.nodes()[nodes[i]];
      path.score = (i == 0 ? node.s_c : node.s_n) + path.score;
    }
    paths.push_back(std::move(path));
  }
  const auto key = [&](const ContactPath& path) {
    std::vector<int> ranks = {graph.nodes()[path.nodes[0]].rank_c};
    for (std::size_t i = 1; i < path.nodes.size(); ++i) {
      ranks.push_back(graph.nodes()[path.nodes[i]].rank_n);
    }
    return std::pair(-path.score, ranks);
  };
  std::sort(paths.begin(), paths.end(),
            [&](const ContactPath& a, const ContactPath& b) { return key(a) < key(b); });
  return paths;
}

void ExpectStatedOrder(const ContactGraph& graph, int stages, TieRule rule) {
  const std::vector<ContactPath> expected = ListInOrder(graph, stages);
  PathSearch search(graph, stages);
  ContactPath path;
  int ties = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_TRUE(search.Next(&path));
    ASSERT_EQ(path.nodes, expected[i].nodes) << i;
    EXPECT_EQ(path.score, expected[i].score);
    const auto tied =
        std::count_if(expected.begin(), expected.end(),
                      [&](const ContactPath& other) { return other.score == path.score; });
    EXPECT_EQ(path.num_tied, tied) << i;
    EXPECT_EQ(path.rule, tied > 1 ? rule : TieRule::kNone) << i;
    ties += tied > 1;
  }
  EXPECT_FALSE(search.Next(&path));
  EXPECT_GT(ties, 10);
}

TEST(PathSearchTest, PathsOfEqualScoreAreCountedAndComeByTheRanksOfTheirNodes) {
  ContactGraph graph = MakeScoredGraph(NoThumbScorer(3.0), AnalyticScorer(50.0), 13.8);
  graph.Prune();
  for (const int stages : {1, 2, 3}) ExpectStatedOrder(graph, stages, TieRule::kScores);
}

TEST(PathSearchTest, PathsThatNothingButNumbersTellApartAreSaidToBe) {
  ContactGraph graph = MakeScoredGraph(ConstantScorer(), ConstantScorer(), 8.0);
  graph.Prune();
  for (const int stages : {1, 2}) ExpectStatedOrder(graph, stages, TieRule::kNumber);
}

TEST(PathSearchTest, ManyPathsOfOneScoreAreCountedUpToALimitAndAllFound) {
  ContactGraph graph = MakeScoredGraph(ConstantScorer(), ConstantScorer(), 12.0);
  graph.Prune();
  PathSearch search(graph, 4);
  ASSERT_GT(search.num_paths(), 2.0 * kMostTied);
  std::set<std::vector<int>> seen;
  for (ContactPath path; search.Next(&path);) {
    EXPECT_EQ(path.num_tied, kMostTied);
    EXPECT_TRUE(seen.insert(path.nodes).second) << "found twice";
  }
  EXPECT_EQ(static_cast<double>(seen.size()), search.num_paths());
}

TEST(PathSearchTest, ACopyGoesOnFromWhereItWasTaken) {
  ExpectCopyGoesOn(PathSearch(MakeGraph(4), 2));
}

TEST(FindSiblingsTest, AreThePathsThatLostByTheirLastNode) {
  for (const int stages : {1, 2, 3}) {
    const ContactGraph graph = MakeGraph(1);
    std::vector<ContactPath> all;
    PathSearch search(graph, stages);
    for (ContactPath path; search.Next(&path);) all.push_back(path);
    for (std::size_t i = 0; i < all.size(); i += 7) {
      std::vector<int> expected;  // last nodes, in the order of the paths
      for (std::size_t j = i + 1; j < all.size(); ++j) {
        const auto& a = all[i].nodes;
        const auto& b = all[j].nodes;
        if (std::equal(a.begin(), a.end() - 1, b.begin())) expected.push_back(b.back());
      }
      const std::size_t count = std::min<std::size_t>(3, expected.size());
      const std::vector<ContactPath> siblings = FindSiblings(graph, all[i], 3);
      ASSERT_EQ(siblings.size(), count);
      for (std::size_t k = 0; k < count; ++k) {
        EXPECT_EQ(siblings[k].nodes.back(), expected[k]);
        EXPECT_NEAR(siblings[k].score,
                    std::accumulate(siblings[k].terms.begin(), siblings[k].terms.end(), 0.0),
                    1e-12);
      }
    }
  }
}

TEST(FindSiblingsTest, SayWhatDecidedBetweenThemAndThePath) {
  ContactGraph graph = MakeScoredGraph(NoThumbScorer(3.0), AnalyticScorer(50.0), 13.8);
  graph.Prune();
  PathSearch search(graph, 1);
  ContactPath best;
  ASSERT_TRUE(search.Next(&best));
  const std::vector<ContactPath> siblings = FindSiblings(graph, best, 100);
  ASSERT_EQ(siblings.size(), 19U);
  for (std::size_t i = 0; i < siblings.size(); ++i) {
    ContactPath next;
    ASSERT_TRUE(search.Next(&next));
    EXPECT_EQ(siblings[i].nodes, next.nodes);
    EXPECT_EQ(siblings[i].num_tied, i < 11 ? 12 : 8);
    EXPECT_EQ(siblings[i].rule, i < 11 ? TieRule::kScores : TieRule::kNone);
  }
}

TEST(PathSearchTest, AnUnprunedGraphOrAWrongLengthIsBadInput) {
  EXPECT_THROW(PathSearch(ContactGraph(MakeBoxMesh(kBoxSize), {}), 2), InputError);
  EXPECT_THROW(PathSearch(MakeGraph(1), 0), InternalError);
}

}  // namespace
}  // namespace pregrasp
