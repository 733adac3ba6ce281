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

TEST(PathSearchTest, ACopyGoesOnFromWhereItWasTaken) {
  PathSearch search(MakeGraph(4), 2);
  ContactPath path;
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(search.Next(&path));
  PathSearch copy = search;
  ContactPath a, b;
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(search.Next(&a));
    ASSERT_TRUE(copy.Next(&b));
    EXPECT_EQ(a.nodes, b.nodes);
    EXPECT_EQ(a.rank, b.rank);
  }
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

TEST(PathSearchTest, AnUnprunedGraphOrAWrongLengthIsBadInput) {
  EXPECT_THROW(PathSearch(ContactGraph(MakeBoxMesh(kBoxSize), {}), 2), InputError);
  EXPECT_THROW(PathSearch(MakeGraph(1), 0), InputError);
}

}  // namespace
}  // namespace pregrasp
