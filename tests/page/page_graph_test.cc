#include "app/page/page_graph.h"

#include <gtest/gtest.h>

#include "app/pictures/words.h"
#include "tests/page/recorded_graph.h"

namespace pregrasp {
namespace {

std::string Unpack(const PackedSentences& packed, std::size_t i) {
  const std::vector<std::string>& parts = packed.sentences[i];
  const std::string& pattern = packed.patterns.at(std::stoul(parts[0]));
  std::string text;
  std::size_t next = 1;
  for (const char c : pattern) {
    if (c == '#') {
      text += parts.at(next++);
    } else {
      text += c;
    }
  }
  return text;
}

TEST(PageGraphTest, PackedSentencesAreTheSameAgain) {
  const std::vector<std::string> sentences = {"node 17 scores 0.250, rank 3 of 1600.",
                                              "node 8 scores 0.500, rank 1 of 1600.",
                                              "none, #4 (1.5.2) ends in 5.", "", "#"};
  const PackedSentences packed = PackSentences(sentences);
  EXPECT_EQ(packed.patterns.size(), 4U);
  for (std::size_t i = 0; i < sentences.size(); ++i) EXPECT_EQ(Unpack(packed, i), sentences[i]);
}

// At every step of the pruning, whole cuts and parts of them.
TEST(PageGraphTest, AGraphRestoredFromItsStepsSaysTheSameOfEveryNode) {
  const RecordedGraph recorded;
  for (std::size_t i = 0; i < recorded.graphs.size(); ++i) {
    const auto restored = RestoreGraph(recorded.steps.at(recorded.ids[i]), recorded, 10.0);
    ASSERT_TRUE(restored.has_value());
    const ContactGraph& graph = recorded.graphs[i];
    EXPECT_EQ(restored->stage(), graph.stage()) << recorded.ids[i];
    EXPECT_EQ(restored->kept(), graph.kept());
    EXPECT_EQ(restored->num_edges(), graph.num_edges());
    for (const ContactNode& node : graph.nodes()) {
      NodeReason reason = graph.Why(node.id);
      reason.node.thumb_fits = reason.node.index_fits = true;  // which steps do not record
      EXPECT_EQ(DescribeReason(restored->Why(node.id)), DescribeReason(reason));
    }
  }
  EXPECT_FALSE(RestoreGraph(recorded.steps.at("graph.mesh"), recorded, 10.0).has_value());
}

TEST(PageGraphTest, ThePageHasEveryNodesScoresAndReason) {
  const RecordedGraph recorded;
  const ContactGraph& graph = recorded.graphs.back();
  const nlohmann::ordered_json page = PageGraph(graph);
  ASSERT_EQ(page["s_c"].size(), graph.nodes().size());
  ASSERT_EQ(page["why"].size(), graph.nodes().size());
  const std::string verdicts = page["verdict"];
  ASSERT_EQ(verdicts.size(), graph.nodes().size());
  for (const ContactNode& node : graph.nodes()) {
    EXPECT_NEAR(page["s_c"][node.id].get<double>(), node.s_c, 5e-5);
    EXPECT_EQ(verdicts[node.id] != 'p', node.kept);
  }
  const std::string svg = GraphSvg(graph);
  std::size_t squares = 0;
  for (std::size_t at = svg.find("<rect"); at != std::string::npos;
       at = svg.find("<rect", at + 1)) {
    ++squares;
  }
  EXPECT_EQ(squares, graph.kept().size() + 1);
}

}  // namespace
}  // namespace pregrasp
