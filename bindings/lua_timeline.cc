#include <fmt/format.h>

#include <algorithm>

#include "app/core/data_folder.h"
#include "app/job/run_summary.h"
#include "app/pictures/words.h"
#include "app/session/saved_state.h"
#include "bindings/lua_planner.h"
#include "bindings/lua_run.h"
#include "bindings/script.h"

namespace pregrasp {
namespace {

const Schema kComparison{"Comparison",
                         {"text", "verdict", "scene", "common", "a", "b", "command", "first",
                          "same_noise", "settings", "scores"}};
const Schema kDifference{"Difference", {"field", "a", "b"}};
const Schema kScoreChange{"ScoreChange", {"id", "thumb", "index", "a", "b", "change"}};

using Node = Timeline::Node;

// The last step on the way to `node`, itself included, whose verb is `verb`. @throws InputError for
// a record that has none, which no planner makes.
const Node& FindVerb(const Node& node, Verb verb) {
  const Node* at = &node;
  while (at != nullptr && at->command.verb != verb) at = at->parent;
  if (at == nullptr) {
    throw InputError(node.id(), "", fmt::format("a step after \"{}\"", VerbName(verb)),
                     "one without");
  }
  return *at;
}

// The first step after the last one of `verb` on the way to `node`, which is not it.
const Node& FirstAfter(const Node& node, Verb verb) {
  const Node& before = FindVerb(node, verb);
  const Node* at = &node;
  while (at->parent != &before) at = at->parent;
  return *at;
}

// The first step of a motion: its first keyframe.
const Node& FirstKeyframe(const Node& node) {
  const Node* at = &FindVerb(node, Verb::kKeyframe);
  while (at->parent->command.verb == Verb::kKeyframe) at = at->parent;
  return *at;
}

// The grasp of a step that tested it, or lifted it.
std::shared_ptr<LuaGrasp> FindGrasp(const std::shared_ptr<Session>& session, const Node& node) {
  const Node& first = FirstAfter(node, Verb::kCertify);
  const auto* lift = std::get_if<LiftFacts>(&node.facts.details);
  const int entry = lift != nullptr ? lift->grasp : std::get<GraspFacts>(node.facts.details).entry;
  const auto grasps = FindGrasps(session, *first.parent, first.command.options);
  if (entry < 1 || entry > std::ssize(grasps->grasps)) {
    throw InputError(node.id(), "entry", fmt::format("1 to {}", grasps->grasps.size()),
                     std::to_string(entry));
  }
  return grasps->grasps[static_cast<std::size_t>(entry) - 1];
}

// A step of the planner as the object that goes on from it.
void PushStep(lua_State* L, const std::shared_ptr<Session>& session, const Node& node) {
  switch (node.command.verb) {
    case Verb::kOpen:
    case Verb::kSettle:
    case Verb::kVerdict:
      return PushObject(L, session);
    case Verb::kMesh:
    case Verb::kScore:
    case Verb::kPrune:
      return PushObject(
          L, std::make_shared<LuaGraph>(LuaGraph{{session, &node}, &FindVerb(node, Verb::kMesh)}));
    case Verb::kPath:
      return PushObject(L, std::make_shared<LuaPath>(LuaPath{
                               {session, &node}, session->timeline().GetState(node)->path}));
    case Verb::kScreen:
    case Verb::kIterate:
      return PushObject(L, std::make_shared<LuaOptimizer>(
                               LuaOptimizer{{session, &node}, &FindVerb(node, Verb::kPath)}));
    case Verb::kCertify:
      return PushObject(L, std::make_shared<LuaTrajectory>(LuaTrajectory{{session, &node}}));
    case Verb::kGrasp:
    case Verb::kLift:
      return PushObject(L, FindGrasp(session, node));
    case Verb::kKeyframe:
    case Verb::kFill:
    case Verb::kSmooth: {
      const Node& first = FirstKeyframe(node);
      const int grasp = CommandOptions(first.command).Int("grasp");
      return PushObject(
          L, std::make_shared<LuaMotion>(LuaMotion{{session, &node}, first.parent, grasp}));
    }
    case Verb::kFrame:
      return PushObject(L, std::make_shared<LuaFrame>(LuaFrame{session, &node}));
    case Verb::kTouch:
    case Verb::kLetGo:
    case Verb::kMove:
    case Verb::kWait: {
      const Node* first = &node;
      while (std::holds_alternative<SimulationFacts>(first->parent->facts.details)) {
        first = first->parent;
      }
      const auto trace = first->command.options.find("trace");
      const bool traced = trace != first->command.options.end() && *trace == true;
      return PushObject(L, std::make_shared<LuaSimulation>(LuaSimulation{session, &node, traced}));
    }
  }
}

void PushDifference(lua_State* L, const FactsDifference& difference) {
  RecordWriter(L, kDifference)
      .Set("field", difference.field)
      .Set("a", difference.left)
      .Set("b", difference.right);
}

// The nodes whose score s_c differs most between two graphs of the same triangles.
void PushScoreChanges(lua_State* L, const ContactGraph& a, const ContactGraph& b) {
  constexpr std::size_t kMost = 10;
  std::vector<int> ids;
  for (const ContactNode& node : a.nodes()) {
    if (node.s_c != b.nodes()[static_cast<std::size_t>(node.id)].s_c) ids.push_back(node.id);
  }
  const auto change = [&](int id) {
    const auto i = static_cast<std::size_t>(id);
    return b.nodes()[i].s_c - a.nodes()[i].s_c;
  };
  std::stable_sort(ids.begin(), ids.end(),
                   [&](int x, int y) { return std::abs(change(x)) > std::abs(change(y)); });
  ids.resize(std::min(ids.size(), kMost));
  lua_createtable(L, static_cast<int>(ids.size()), 0);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const ContactNode& node = a.nodes()[static_cast<std::size_t>(ids[i])];
    RecordWriter(L, kScoreChange)
        .Set("id", node.id)
        .Set("thumb", node.thumb)
        .Set("index", node.index)
        .Set("a", node.s_c)
        .Set("b", b.nodes()[static_cast<std::size_t>(node.id)].s_c)
        .Set("change", change(node.id));
    lua_rawseti(L, -2, static_cast<lua_Integer>(i) + 1);
  }
}

Pushed ComparePlaces(lua_State* L, const AnyPlace& a, const AnyPlace& b) {
  const Timeline &one = a.session->timeline(), &other = b.session->timeline();
  const BranchComparison comparison = CompareBranches(one, *a.node, other, *b.node);
  const Explanation why = ExplainDifference(comparison, a.session->scene(), b.session->scene(),
                                            a.node->facts, b.node->facts, one, other);
  RecordWriter record(L, kComparison);
  record.Set("text", why.text).Set("verdict", why.verdict);
  if (comparison.common != nullptr) record.Set("common", comparison.common->id());
  if (comparison.left != nullptr) record.Set("a", comparison.left->id());
  if (comparison.right != nullptr) record.Set("b", comparison.right->id());
  record.Set("same_noise", comparison.same_noise);
  if (comparison.scene) {
    PushDifference(L, *comparison.scene);
    record.SetTop("scene");
  }
  if (comparison.command) {
    PushDifference(L, *comparison.command);
    record.SetTop("command");
  }
  if (comparison.facts) {
    PushDifference(L, *comparison.facts);
    record.SetTop("first");
  }
  lua_createtable(L, static_cast<int>(comparison.settings.size()), 0);
  for (std::size_t i = 0; i < comparison.settings.size(); ++i) {
    PushDifference(L, comparison.settings[i]);
    lua_rawseti(L, -2, static_cast<lua_Integer>(i) + 1);
  }
  record.SetTop("settings");
  const auto x = one.GetState(*a.node)->graph, y = other.GetState(*b.node)->graph;
  const bool scored = x && y && x->stage() != GraphStage::kMeshed &&
                      y->stage() != GraphStage::kMeshed && x->nodes().size() == y->nodes().size();
  if (scored && a.session != b.session) {
    PushScoreChanges(L, *x, *y);
    record.SetTop("scores");
  }
  return {1};
}

// A link could lead out of the folders that a script may read; a run has but one, for MRPT's tools.
void RefuseLinks(const std::filesystem::path& run) {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(run)) {
    if (!entry.is_symlink() || entry.path().filename() == "pictures_Images") continue;
    throw InputError("", "dir", "a run of plain files",
                     "a link, " + entry.path().filename().string());
  }
}

// load_state(dir): the session, and the object at the step where it stood.
Pushed LoadState(lua_State* L, const std::string& dir) {
  const ScriptContext& context = ScriptContext::Of(L);
  const std::filesystem::path run =
      Machine::Of(L).files().FindForReading(dir + "/manifest.json").parent_path();
  RefuseLinks(run);
  constexpr int kSessionKib = 2000;
  CountMemory(L, kSessionKib);
  MemoryClaim claim = ClaimMemory(L, std::size_t{kSessionKib} << 10U);
  const ResumedSession resumed =
      ResumeSession(run, context.config.threads,
                    context.config.weights.empty() ? DataFolder() / "assets" / "weights"
                                                   : context.config.weights);
  resumed.session->claim() = std::move(claim);
  CountSteps(L, *resumed.session);
  PushObject(L, resumed.session);
  PushStep(L, resumed.session, *resumed.node);
  return {2};
}

}  // namespace

AnyPlace LuaValue<AnyPlace>::Read(lua_State* L, int index, const std::string& path) {
  const auto of = [](const Cursor& cursor) { return AnyPlace{cursor.session, cursor.node}; };
  if (const auto session = FindObject<Session>(L, index)) {
    return {session, &session->timeline().last()};
  }
  if (const auto graph = FindObject<LuaGraph>(L, index)) return of(*graph);
  if (const auto path_object = FindObject<LuaPath>(L, index)) {
    if (!path_object->recorded()) RequireNotAsking(L, path_object->cursor.session.get());
    path_object->Record();
    return of(path_object->cursor);
  }
  if (const auto optimizer = FindObject<LuaOptimizer>(L, index)) return of(*optimizer);
  if (const auto trajectory = FindObject<LuaTrajectory>(L, index)) return of(*trajectory);
  if (const auto grasps = FindObject<LuaGrasps>(L, index)) return of(*grasps);
  if (const auto grasp = FindObject<LuaGrasp>(L, index)) {
    return {grasp->all.session, grasp->lift != nullptr ? grasp->lift : grasp->step};
  }
  if (const auto motion = FindObject<LuaMotion>(L, index)) return of(*motion);
  if (const auto frame = FindObject<LuaFrame>(L, index)) return {frame->session, frame->node};
  if (const auto simulation = FindObject<LuaSimulation>(L, index)) {
    return {simulation->session, simulation->node};
  }
  if (const auto plan = FindObject<LuaPlan>(L, index)) {
    return {plan->session,
            plan->place.node != nullptr ? plan->place.node : &plan->session->timeline().root()};
  }
  throw InputError("", path, "a session or an object that it gave", DescribeValue(L, index));
}

Pushed SessionGo(lua_State* L, const std::shared_ptr<Session>& session, const std::string& id) {
  PushStep(L, session, session->timeline().Find(id));
  return {1};
}

Pushed SessionStep(lua_State* L, Session& session, const std::string& id) {
  const Node& node = session.timeline().Find(id);
  PushJson(L, FactsToJson(node.facts, node.number));
  return {1};
}

std::vector<std::string> SessionIds(Session& session) {
  std::vector<std::string> ids;
  for (const auto& node : session.timeline().nodes()) ids.push_back(node->id());
  return ids;
}

std::string SessionSaveState(lua_State* L, const std::shared_ptr<Session>& session,
                             const std::string& dir, const std::optional<AnyPlace>& at) {
  if (at && at->session != session) {
    throw InputError("", "at", "an object of this session", "one of another");
  }
  const std::filesystem::path directory = Machine::Of(L).files().ResolveForWriting(dir);
  session->SaveState(directory, at ? *at->node : session->timeline().last());
  return directory.string();
}

Pushed SessionWhy(lua_State* L, const std::shared_ptr<Session>& session) {
  const Timeline& timeline = session->timeline();
  const Node& end = FindFurthest(timeline);
  Explanation why;
  why.verdict = StatusAt(timeline, end).value_or("open");
  why.text = fmt::format("The furthest that it came is {}: {}.", end.id(), why.verdict);
  const Explanation path = ExplainPathOf(timeline, end);
  if (!path.text.empty()) why.text += " " + path.text + ".";
  why.items = path.items;
  // One grasp or lift of many says little of what they came to.
  const bool one_of_many = end.command.verb == Verb::kGrasp || end.command.verb == Verb::kLift;
  if (one_of_many) return PushExplanation(L, why);
  for (const std::string& line : DescribeStep(session->scene(), end.facts, timeline)) {
    if (line.find('\t') == std::string::npos) why.text += " " + line;
  }
  return PushExplanation(L, why);
}

Pushed SessionWhyNot(lua_State* L, Session& session, int path) {
  RequireRank(path);
  const Timeline& timeline = session.timeline();
  return PushExplanation(L, ExplainPathAgainstEnd(timeline, FindFurthest(timeline), path));
}

void RequireRank(int path) {
  if (path < 1) throw InputError("", "path", "the rank of a path, from 1", std::to_string(path));
}

const std::vector<FunctionInfo>& TimelineFunctions() {
  static const std::vector<FunctionInfo> functions = {Function<&ComparePlaces>("compare", "a, b"),
                                                      Function<&LoadState>("load_state", "dir")};
  return functions;
}

std::vector<const Schema*> TimelineSchemas() { return {&kComparison, &kDifference, &kScoreChange}; }

}  // namespace pregrasp
