#pragma once

#include <map>
#include <string>
#include <vector>

#include "app/job/step_facts.h"
#include "tests/graph/graph_fixture.h"

namespace pregrasp {

/// A contact graph after every step of its pruning, with what the steps record of it.
struct RecordedGraph : FactsSource {
  RecordedGraph() {
    ContactGraph graph = MakeScoredGraph(AnalyticScorer(3.0, -0.01), AnalyticScorer(50.0), 10.0);
    MeshFacts mesh;
    mesh.mesh = graph.mesh();
    Add("graph.mesh", Verb::kMesh, mesh, "");
    ScoreFacts scores;
    scores.samples = graph.config().samples;
    for (const ContactNode& node : graph.nodes()) {
      scores.s_c.push_back(node.s_c);
      scores.s_n.push_back(node.s_n);
      scores.occluded.push_back(node.occluded);
    }
    Add("graph.score", Verb::kScore, scores, "graph.mesh");
    Keep("graph.score", graph);
    std::string before = "graph.score";
    for (const int nodes : {4, 1000, 3, 1000, 2, 1000}) {
      const GraphStage stage = graph.stage();
      graph.PruneStep(nodes);
      PruneFacts facts;
      facts.cut = stage == GraphStage::kScored          ? "context"
                  : stage == GraphStage::kPrunedContext ? "free"
                                                        : "edges";
      facts.complete = graph.stage() == GraphStage::kConnected;
      facts.nodes_done = graph.num_done();
      facts.top_percent = graph.config().top_percent;
      const std::string id = "graph.prune." + std::to_string(graph.num_prune_steps());
      Add(id, Verb::kPrune, facts, before);
      Keep(id, graph);
      before = id;
    }
  }

  const StepFacts& Get(const std::string& id) const override { return steps.at(id); }

  std::map<std::string, StepFacts> steps;
  std::vector<std::string> ids;  ///< of `graphs`
  std::vector<ContactGraph> graphs;

 private:
  void Add(const std::string& id, Verb verb, StepDetails details, const std::string& node) {
    StepFacts& step = steps[id];
    step.id = id;
    step.command = {verb, node};
    step.details = std::move(details);
  }
  void Keep(const std::string& id, const ContactGraph& graph) {
    ids.push_back(id);
    graphs.push_back(graph);
  }
};

}  // namespace pregrasp
