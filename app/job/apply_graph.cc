#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "app/core/error.h"
#include "app/job/apply_stages.h"

namespace pregrasp::internal {
namespace {

constexpr int kSiblings = 5;            // told of a path
constexpr std::size_t kMostStages = 8;  // as paths.stages

NodeFacts MakeNodeFacts(const ContactNode& node) {
  return {node.id,     node.thumb,  node.index,      node.s_c,       node.s_n,
          node.rank_c, node.rank_n, node.thumb_fits, node.index_fits};
}

const char* TieRuleName(TieRule rule) {
  switch (rule) {
    case TieRule::kNone:
      return "";
    case TieRule::kScores:
      return "scores";
    case TieRule::kNumber:
      return "number";
  }
  return "";
}

void BuildMesh(Application& a) {
  a.next.ForgetGraph();
  a.next.planner = a.job.GetPlanner(a.next.start, a.next.config);
  const PlannerConfig& config = a.next.config;
  const auto graph =
      std::make_shared<const ContactGraph>(a.next.planner->BuildGraph(config.mesh, config.graph));
  a.facts.id = "graph.mesh";
  a.facts.details =
      MeshFacts{graph->num_triangles(), static_cast<int>(graph->nodes().size()), graph->mesh()};
  a.next.graph = graph;
}

void Score(Application& a) {
  Require(a.next.graph != nullptr, "a graph", "none");
  Require(a.next.graph->stage() == GraphStage::kMeshed, "a graph without scores",
          "one that has them");
  auto graph = std::make_shared<ContactGraph>(*a.next.graph);
  a.next.planner->ScoreGraph(*graph);
  a.facts.id = "graph.score";
  ScoreFacts facts;
  facts.samples = graph->config().samples;
  for (const ContactNode& node : graph->nodes()) {
    facts.s_c.push_back(node.s_c);
    facts.s_n.push_back(node.s_n);
    facts.occluded.push_back(node.occluded);
    if (node.rank_c == 1) facts.best_here = MakeNodeFacts(node);
    if (node.rank_n == 1) facts.best_alone = MakeNodeFacts(node);
  }
  a.facts.details = std::move(facts);
  a.next.graph = std::move(graph);
}

// What the pruning step that `graph` has taken last, or is taking, cuts by.
const char* CutName(const ContactGraph& graph) {
  int stage = static_cast<int>(graph.stage());
  if (graph.num_done() > 0) ++stage;
  switch (static_cast<GraphStage>(stage)) {
    case GraphStage::kPrunedContext:
      return "context";
    case GraphStage::kPrunedFree:
      return "free";
    default:
      return "edges";
  }
}

void Prune(Application& a) {
  Require(a.next.graph && a.next.graph->stage() != GraphStage::kMeshed, "a graph with scores",
          "one without: call score() first");
  const CommandOptions options(a.command);
  auto graph = std::make_shared<ContactGraph>(*a.next.graph);
  if (a.next.config.graph.top_percent != graph->config().top_percent) {
    graph->SetTopPercent(a.next.config.graph.top_percent);
  }
  const int nodes = options.Has("nodes") ? options.Int("nodes") : std::numeric_limits<int>::max();
  if (nodes < 1) {
    throw InputError("", "nodes", "a whole number from 1", std::to_string(nodes));
  }
  Require(graph->PruneStep(nodes), "a graph with something to prune", "one that is complete");
  a.facts.id = fmt::format("graph.prune.{}", graph->num_prune_steps());
  PruneFacts facts;
  const NodeReason any = graph->Why(0);
  facts.cut = CutName(*graph);
  facts.complete = graph->stage() == GraphStage::kConnected;
  facts.nodes_done = graph->num_done();
  facts.top_percent = graph->config().top_percent;
  facts.num_kept_each = any.num_kept_each;
  facts.threshold_c = any.threshold_c;
  facts.threshold_n = any.threshold_n;
  facts.num_tied_c = any.num_tied_c;
  facts.num_tied_n = any.num_tied_n;
  facts.num_edges = graph->num_edges();
  for (const ContactNode& node : graph->nodes()) {
    if (node.initial) facts.initial.push_back(node.id);
    if (node.kept) facts.kept.push_back(node.id);
  }
  a.facts.details = std::move(facts);
  a.next.graph = graph;
  if (graph->stage() == GraphStage::kConnected) {
    a.next.paths = std::make_shared<PathList>(graph);
  }
}

// The path of the command's rank in the order.
std::shared_ptr<const ContactPath> FindRanked(const Application& a) {
  const int rank = CommandOptions(a.command).Int("rank");
  const PathOrder order = a.next.config.order;
  const int stages = a.next.config.stages;
  auto path = a.next.paths->Find(order, stages, rank);
  if (!path) {
    throw InputError("", "rank",
                     fmt::format("at most {:.0f} paths", a.next.paths->Count(order, stages)),
                     std::to_string(rank));
  }
  return path;
}

// The path of the command's nodes, which are put together by hand: it has no rank.
std::shared_ptr<const ContactPath> BuildPath(const Application& a) {
  const nlohmann::json& nodes = CommandOptions(a.command).Get("nodes");
  const std::vector<ContactNode>& all = a.next.graph->nodes();
  if (!nodes.is_array() || nodes.empty() || nodes.size() > kMostStages) {
    throw InputError("", "nodes", fmt::format("a list of 1 to {} nodes", kMostStages),
                     nodes.is_array() ? std::to_string(nodes.size()) : nodes.dump());
  }
  auto path = std::make_shared<ContactPath>();
  for (const nlohmann::json& id : nodes) {
    if (!id.is_number_integer() || id < 0 || id >= std::ssize(all)) {
      throw InputError("", "nodes", fmt::format("a node from 0 to {}", all.size() - 1), id.dump());
    }
    const ContactNode& node = all[id.get<std::size_t>()];
    path->terms.push_back(path->nodes.empty() ? node.s_c : node.s_n);
    path->nodes.push_back(node.id);
  }
  for (auto term = path->terms.rbegin(); term != path->terms.rend(); ++term) path->score += *term;
  path->value = path->score;
  return path;
}

void TakePath(Application& a) {
  Require(a.next.paths != nullptr, "a graph that has been pruned", "one that has not");
  const bool by_hand = CommandOptions(a.command).Has("nodes");
  const PathOrder order = a.next.config.order;
  const int stages = a.next.config.stages;
  const auto path = by_hand ? BuildPath(a) : FindRanked(a);
  a.facts.id = by_hand ? "paths.hand" : fmt::format("paths.rank.{}", path->rank);
  PathFacts facts;
  facts.rank = path->rank;
  for (const int id : path->nodes) facts.nodes.push_back(MakeNodeFacts(a.next.graph->nodes()[id]));
  facts.score = path->score;
  facts.terms = path->terms;
  facts.order = by_hand ? "hand" : PathOrderName(order);
  facts.value = path->value;
  facts.repeats = path->repeats;
  facts.num_paths = a.next.paths->Count(order, stages);
  facts.num_tied = path->num_tied;
  facts.tie_rule = TieRuleName(path->rule);
  if (!by_hand) {
    for (const ContactPath& sibling : FindSiblings(*a.next.graph, *path, kSiblings)) {
      facts.siblings.push_back({sibling.nodes, sibling.score});
    }
  }
  a.facts.details = std::move(facts);
  a.next.ForgetPath();
  a.next.path = path;
}

}  // namespace

void ApplyGraph(Application& a) {
  if (a.command.verb == Verb::kMesh) BuildMesh(a);
  if (a.command.verb == Verb::kScore) Score(a);
  if (a.command.verb == Verb::kPrune) Prune(a);
  if (a.command.verb == Verb::kPath) TakePath(a);
}

}  // namespace pregrasp::internal
