#include <fmt/format.h>

#include <algorithm>

#include "app/pictures/words.h"
#include "bindings/lua_array.h"
#include "bindings/lua_planner.h"

namespace pregrasp {
namespace {

const Schema kContactState{"ContactState",
                           {"id", "thumb", "index", "s_c", "s_n", "rank_c", "rank_n", "occluded",
                            "thumb_fits", "index_fits", "initial", "kept"}};
const Schema kNodeKey{"NodeKey", {"thumb", "index"}};
const Schema kTrianglesOptions{"TrianglesOptions", {"finger", "count"}};
const Schema kTriangleScore{
    "TriangleScore",
    {"triangle", "finger", "best", "mean", "node", "kept", "fits", "p_OCentre", "nhat_O", "area"}};

const char* StageName(GraphStage stage) {
  switch (stage) {
    case GraphStage::kMeshed:
      return "meshed";
    case GraphStage::kScored:
      return "scored";
    case GraphStage::kPrunedContext:
      return "pruned_context";
    case GraphStage::kPrunedFree:
      return "pruned_free";
    case GraphStage::kConnected:
      return "connected";
  }
  return "";
}

const char* VerdictName(NodeReason::Verdict verdict) {
  switch (verdict) {
    case NodeReason::Verdict::kNotScored:
      return "not_scored";
    case NodeReason::Verdict::kScored:
      return "scored";
    case NodeReason::Verdict::kKeptByContext:
      return "kept_by_context";
    case NodeReason::Verdict::kKeptByFree:
      return "kept_by_free";
    case NodeReason::Verdict::kKeptByBoth:
      return "kept_by_both";
    case NodeReason::Verdict::kPruned:
      return "pruned";
  }
  return "";
}

void RequireScores(const ContactGraph& graph) {
  if (graph.stage() == GraphStage::kMeshed)
    throw InputError("", "", "a graph with scores", "one without: call score() first");
}

// A node by its id, or by its triangles: {thumb = 3, index = 17}.
struct NodeKey {
  std::optional<int> id;
  int thumb = 0, index = 0;

  // @throws InputError for triangles that the graph does not have.
  int Find(const ContactGraph& graph) const {
    if (id) return *id;
    const int count = graph.num_triangles();
    for (const auto& [name, triangle] : {std::pair("thumb", thumb), std::pair("index", index)}) {
      if (triangle >= 0 && triangle < count) continue;
      throw InputError("", name, fmt::format("a triangle from 0 to {}", count - 1),
                       std::to_string(triangle));
    }
    return thumb * count + index;
  }
};

struct TrianglesOptions {
  Finger finger = Finger::kThumb;
  int count = 10;
};

}  // namespace

void PushNode(lua_State* L, const ContactNode& node) {
  RecordWriter(L, kContactState)
      .Set("id", node.id)
      .Set("thumb", node.thumb)
      .Set("index", node.index)
      .Set("s_c", node.s_c)
      .Set("s_n", node.s_n)
      .Set("rank_c", node.rank_c)
      .Set("rank_n", node.rank_n)
      .Set("occluded", node.occluded)
      .Set("thumb_fits", node.thumb_fits)
      .Set("index_fits", node.index_fits)
      .Set("initial", node.initial)
      .Set("kept", node.kept);
}

template <>
struct LuaValue<NodeKey> {
  static NodeKey Read(lua_State* L, int index, const std::string& path) {
    if (!lua_istable(L, index)) return {LuaValue<int>::Read(L, index, path)};
    const Fields fields(L, index, kNodeKey);
    return {std::nullopt, fields.Required<int>("thumb"), fields.Required<int>("index")};
  }
};

template <>
struct LuaValue<TrianglesOptions> {
  static TrianglesOptions Read(lua_State* L, int index, const std::string& /*path*/) {
    const Fields fields(L, index, kTrianglesOptions);
    TrianglesOptions options;
    options.finger = fields.Optional<Finger>("finger", options.finger);
    options.count = fields.Optional<int>("count", options.count);
    if (options.finger != Finger::kThumb && options.finger != Finger::kIndex) {
      fields.Refuse("finger", "\"thumb\" or \"index\"");
    }
    return options;
  }
};

namespace {

// Methods of a graph.

void GraphScore(lua_State* L, LuaGraph& graph) {
  graph.Do(Verb::kScore);
  CountSteps(L, *graph.session);
}

bool IsConnected(const LuaGraph& graph) { return graph.graph()->stage() == GraphStage::kConnected; }

bool GraphPruneStep(lua_State* L, LuaGraph& graph, const std::optional<int>& nodes) {
  RequireScores(*graph.graph());
  if (nodes && *nodes < 1) {
    throw InputError("", "nodes", "a whole number from 1", std::to_string(*nodes));
  }
  if (IsConnected(graph)) return false;
  graph.Do(Verb::kPrune, nodes ? nlohmann::json{{"nodes", *nodes}} : nlohmann::json::object());
  CountSteps(L, *graph.session);
  return true;
}

void GraphPrune(lua_State* L, LuaGraph& graph, const PruneOptions& options) {
  RequireScores(*graph.graph());
  nlohmann::json command = nlohmann::json::object();
  if (!options.fields.empty()) {
    command["settings"] = options.ToSettings();
    if (graph.graph()->stage() != GraphStage::kScored) {
      throw InputError("", "top_percent", "a graph that is not pruned yet", "one that is");
    }
  }
  graph.node = &PruneAll(graph.session->timeline(), *graph.node, std::move(command));
  CountSteps(L, *graph.session);
}

void GraphBack(LuaGraph& graph, const std::optional<int>& steps) {
  graph.Back(steps.value_or(1), graph.first);
}

Pushed GraphFork(lua_State* L, LuaGraph& graph) {
  PushObject(L, std::make_shared<LuaGraph>(graph));
  return {1};
}

void GraphForward(LuaGraph& graph, const std::optional<int>& steps) {
  graph.Forward(steps.value_or(1));
}

Pushed GraphWhy(lua_State* L, LuaGraph& graph, const NodeKey& node) {
  const auto of = graph.graph();
  PushObject(L, std::make_shared<LuaReason>(LuaReason{of->Why(node.Find(*of))}));
  return {1};
}

Pushed GraphNode(lua_State* L, LuaGraph& graph, const NodeKey& node) {
  const auto of = graph.graph();
  PushNode(L, of->Why(node.Find(*of)).node);
  return {1};
}

// The triangles by the best score that a node with the finger there has.
Pushed GraphTriangleScores(lua_State* L, LuaGraph& graph, const TrianglesOptions& options) {
  const auto of = graph.graph();
  RequireScores(*of);
  struct Triangle {
    int triangle = 0, kept = 0, count = 0;
    const ContactNode* best = nullptr;
    double sum = 0.0;
    bool fits = false;
  };
  const bool thumb = options.finger == Finger::kThumb;
  std::vector<Triangle> triangles(static_cast<std::size_t>(of->num_triangles()));
  for (const ContactNode& node : of->nodes()) {
    const int number = thumb ? node.thumb : node.index;
    Triangle& triangle = triangles[static_cast<std::size_t>(number)];
    triangle.triangle = number;
    triangle.kept += node.kept ? 1 : 0;
    triangle.sum += node.s_c;
    ++triangle.count;
    triangle.fits = thumb ? node.thumb_fits : node.index_fits;
    if (triangle.best == nullptr || node.rank_c < triangle.best->rank_c) triangle.best = &node;
  }
  std::sort(triangles.begin(), triangles.end(),
            [](const Triangle& a, const Triangle& b) { return a.best->rank_c < b.best->rank_c; });
  const int shown = std::clamp(options.count, 0, of->num_triangles());
  lua_createtable(L, shown, 0);
  for (int i = 0; i < shown; ++i) {
    const Triangle& triangle = triangles[static_cast<std::size_t>(i)];
    const TriangleShape shape = CalcTriangleShape(of->mesh(), triangle.triangle);
    RecordWriter(L, kTriangleScore)
        .Set("triangle", triangle.triangle)
        .Set("finger", options.finger)
        .Set("best", triangle.best->s_c)
        .Set("mean", triangle.sum / triangle.count)
        .Set("node", triangle.best->id)
        .Set("kept", triangle.kept)
        .Set("fits", triangle.fits)
        .Set("p_OCentre", shape.p_OCentre)
        .Set("nhat_O", shape.nhat_O)
        .Set("area", shape.area);
    lua_rawseti(L, -2, i + 1);
  }
  return {1};
}

// A path of these nodes, by their ids or triangles, as a step.
Pushed GraphPath(lua_State* L, LuaGraph& graph, const std::vector<NodeKey>& nodes) {
  if (!IsConnected(graph)) {
    throw InputError("", "nodes", "a graph that has been pruned", "one that has not");
  }
  const auto of = graph.graph();
  nlohmann::json ids = nlohmann::json::array();
  for (const NodeKey& node : nodes) ids.push_back(node.Find(*of));
  auto path = std::make_shared<LuaPath>(LuaPath{{graph.session, graph.node}, nullptr});
  path->cursor.Do(Verb::kPath, {{"nodes", std::move(ids)}});
  path->path = path->cursor.state()->path;
  PushObject(L, std::move(path));
  return {1};
}

Pushed GraphTop(lua_State* L, LuaGraph& graph, const std::optional<int>& count) {
  RequireScores(*graph.graph());
  std::vector<ContactNode> nodes = graph.graph()->nodes();
  std::sort(nodes.begin(), nodes.end(),
            [](const ContactNode& a, const ContactNode& b) { return a.rank_c < b.rank_c; });
  const int shown = std::clamp(count.value_or(10), 0, static_cast<int>(nodes.size()));
  lua_createtable(L, shown, 0);
  for (int i = 0; i < shown; ++i) {
    PushNode(L, nodes[static_cast<std::size_t>(i)]);
    lua_rawseti(L, -2, i + 1);
  }
  return {1};
}

std::vector<int> GraphNeighbors(LuaGraph& graph, int id) {
  if (graph.graph()->stage() != GraphStage::kConnected) {
    throw InputError("", "", "a connected graph", "one before prune()");
  }
  return graph.graph()->Why(id).node.kept ? graph.graph()->neighbors(id) : std::vector<int>{};
}

Pushed GraphPaths(lua_State* L, LuaGraph& graph, const PathsOptions& options) {
  if (!IsConnected(graph)) {
    throw InputError("", "", "a graph that has been pruned",
                     "one that has not: call prune() first");
  }
  LuaPaths paths{{graph.session, graph.node, options.ToSettings()}};
  PlannerConfig config = graph.state()->config;
  ApplySettings(paths.settings, config);
  paths.filter = options.filter;
  paths.order = config.order;
  paths.stages = config.stages;
  graph.state()->paths->Count(paths.order, paths.stages);  // refuses what cannot be
  PushObject(L, std::make_shared<LuaPaths>(std::move(paths)));
  return {1};
}

void GraphShot(lua_State* L, LuaGraph& graph, const ShotOptions& options) {
  TakeShot(L, *graph.session, *graph.node, options);
}

// Properties of a graph.

std::string GraphStageName(LuaGraph& graph) { return StageName(graph.graph()->stage()); }
std::string GraphStepId(LuaGraph& graph) { return graph.step_id(); }
int GraphTriangles(LuaGraph& graph) { return graph.graph()->num_triangles(); }
int GraphNodes(LuaGraph& graph) { return static_cast<int>(graph.graph()->nodes().size()); }
int GraphEdges(LuaGraph& graph) {
  return graph.graph()->stage() == GraphStage::kConnected ? graph.graph()->num_edges() : 0;
}
double GraphTopPercent(LuaGraph& graph) { return graph.graph()->config().top_percent; }
std::vector<int> GraphKept(LuaGraph& graph) {
  std::vector<int> kept;
  for (const ContactNode& node : graph.graph()->nodes()) {
    if (node.kept) kept.push_back(node.id);
  }
  return kept;
}
std::vector<int> GraphInitial(LuaGraph& graph) {
  std::vector<int> initial;
  for (const ContactNode& node : graph.graph()->nodes()) {
    if (node.initial) initial.push_back(node.id);
  }
  return initial;
}
// The graph for an array to hold, counted as the script's memory.
std::shared_ptr<const ContactGraph> HoldGraph(lua_State* L, const LuaGraph& graph) {
  const auto of = graph.graph();
  const auto held = ShareArrayData(L, of, of->nodes().size() * sizeof(ContactNode));
  return {held, held->get()};
}

LuaArray GraphAllNodes(lua_State* L, LuaGraph& graph) {
  const auto of = HoldGraph(L, graph);
  const auto push = [of](lua_State* state, int id) {
    PushNode(state, of->nodes()[static_cast<std::size_t>(id)]);
  };
  return {"ContactState", static_cast<int>(of->nodes().size()), push};
}
Pushed GraphMesh(lua_State* L, LuaGraph& graph) {
  const auto of = HoldGraph(L, graph);
  PushMesh(L, {of, &of->mesh()});
  return {1};
}

int GraphToString(lua_State* L) {
  const auto graph = FindObject<LuaGraph>(L, 1);
  const std::string text =
      graph ? fmt::format("Graph({}, {} nodes)", StageName(graph->graph()->stage()),
                          graph->graph()->nodes().size())
            : "Graph";
  lua_pushlstring(L, text.data(), text.size());
  return 1;
}

// Properties of a reason.

int ReasonId(LuaReason& why) { return why.reason.node.id; }
Pushed ReasonNode(lua_State* L, LuaReason& why) {
  PushNode(L, why.reason.node);
  return {1};
}
std::string ReasonVerdict(LuaReason& why) { return VerdictName(why.reason.verdict); }
bool ReasonKept(LuaReason& why) { return why.reason.node.kept; }
int ReasonNumNodes(LuaReason& why) { return why.reason.num_nodes; }
int ReasonNumKept(LuaReason& why) { return why.reason.num_kept_each; }
double ReasonThresholdC(LuaReason& why) { return why.reason.threshold_c; }
double ReasonThresholdN(LuaReason& why) { return why.reason.threshold_n; }
std::string ReasonText(LuaReason& why) { return DescribeReason(why.reason); }

int ReasonToString(lua_State* L) {
  const auto why = FindObject<LuaReason>(L, 1);
  const std::string text = why ? DescribeReason(why->reason) : "Reason";
  lua_pushlstring(L, text.data(), text.size());
  return 1;
}

}  // namespace

Pushed SessionGraph(lua_State* L, const std::shared_ptr<Session>& session,
                    const GraphOptions& options) {
  LuaGraph graph{{session, &session->start(), options.ToSettings()}};
  graph.Do(Verb::kMesh);
  CountSteps(L, *session);
  graph.first = graph.node;
  PushObject(L, std::make_shared<LuaGraph>(std::move(graph)));
  return {1};
}

const ClassInfo& GraphClass() {
  static const ClassInfo info{"Graph",
                              {
                                  Method<&GraphScore>("score"),
                                  Method<&GraphPrune>("prune", "options"),
                                  Method<&GraphPruneStep>("prune_step", "nodes"),
                                  Query<&GraphWhy>("why", "id"),
                                  Query<&GraphWhy>("why_not", "id"),
                                  Query<&GraphNode>("node", "id"),
                                  Query<&GraphTriangleScores>("triangles", "options"),
                                  Query<&GraphTop>("top", "count"),
                                  Query<&GraphNeighbors>("neighbors", "id"),
                                  Method<&GraphPaths>("paths", "options"),
                                  Method<&GraphPath>("path", "nodes"),
                                  Method<&GraphWhatIf>("what_if", "options"),
                                  Method<&GraphBack>("back", "steps"),
                                  Method<&GraphForward>("forward", "steps"),
                                  Query<&GraphFork>("fork"),
                                  Method<&GraphShot>("shot", "options"),
                              },
                              {
                                  Property<&GraphStageName>("stage"),
                                  Property<&GraphStepId>("step_id"),
                                  Property<&GraphTriangles>("num_triangles"),
                                  Property<&GraphNodes>("num_nodes"),
                                  Property<&GraphEdges>("num_edges"),
                                  Property<&GraphTopPercent>("top_percent"),
                                  Property<&GraphAllNodes>("nodes"),
                                  Property<&GraphInitial>("initial"),
                                  Property<&GraphKept>("kept"),
                                  Property<&GraphMesh>("mesh"),
                              },
                              GraphToString};
  return info;
}

const ClassInfo& ReasonClass() {
  static const ClassInfo info{"Reason",
                              {},
                              {
                                  Property<&ReasonText>("text"),
                                  Property<&ReasonVerdict>("verdict"),
                                  Property<&ReasonKept>("kept"),
                                  Property<&ReasonId>("id"),
                                  Property<&ReasonNode>("node"),
                                  Property<&ReasonThresholdC>("threshold_c"),
                                  Property<&ReasonThresholdN>("threshold_n"),
                                  Property<&ReasonNumNodes>("num_nodes"),
                                  Property<&ReasonNumKept>("num_kept_each"),
                              },
                              ReasonToString};
  return info;
}

std::vector<const Schema*> GraphSchemas() {
  return {&kContactState, &kNodeKey, &kTrianglesOptions, &kTriangleScore};
}

}  // namespace pregrasp
