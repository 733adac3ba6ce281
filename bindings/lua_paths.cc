#include <fmt/format.h>

#include "app/core/interrupt.h"
#include "bindings/lua_planner.h"

namespace pregrasp {
namespace {

const Schema kSibling{"Sibling", {"nodes", "score", "behind"}};

constexpr int kMostPaths = 100000;  // that top(n) lists
constexpr int kSiblings = 5;

// The path of a rank; null beyond the last one.
std::shared_ptr<LuaPath> FindPath(const LuaPaths& paths, int rank) {
  auto found = paths.state()->paths->Find(paths.order, paths.stages, rank);
  if (!found) return nullptr;
  return std::make_shared<LuaPath>(
      LuaPath{{paths.session, paths.node, paths.settings}, std::move(found)});
}

// Whether the script's filter lets it count.
bool Counts(lua_State* L, const LuaPaths& paths, const std::shared_ptr<LuaPath>& path) {
  if (!paths.filter) return true;
  const StandStill still(L, paths.session.get());
  luaL_checkstack(L, 4, "a filter");
  paths.filter->Push(L);
  PushObject(L, path);
  return AskFunction(L);
}

// The first path from `rank` on that counts, and its rank; null after the last one.
std::shared_ptr<LuaPath> FindNext(lua_State* L, const LuaPaths& paths, int rank) {
  for (;; ++rank) {
    ThrowIfInterrupted();
    if (rank > kMostPaths) {
      throw InputError("", "filter", fmt::format("a yes to one of the first {} paths", kMostPaths),
                       "none");
    }
    std::shared_ptr<LuaPath> path = FindPath(paths, rank);
    if (!path || Counts(L, paths, path)) return path;
  }
}

Pushed PathsNext(lua_State* L, LuaPaths& paths) {
  const std::shared_ptr<LuaPath> path = FindNext(L, paths, paths.next);
  if (!path) {
    lua_pushnil(L);
    return {1};
  }
  path->Record();
  paths.next = path->path->rank + 1;
  PushObject(L, path);
  return {1};
}

Pushed PathsTop(lua_State* L, LuaPaths& paths, int count) {
  if (count < 0 || count > kMostPaths) {
    throw InputError("", "count", "0 to 100000", std::to_string(count));
  }
  lua_createtable(L, 0, 0);
  int rank = 1;
  for (int i = 1; i <= count; ++i) {
    const std::shared_ptr<LuaPath> path = FindNext(L, paths, rank);
    if (!path) break;
    rank = path->path->rank + 1;
    PushObject(L, path);
    lua_rawseti(L, -2, i);
  }
  return {1};
}

// Why a path has its rank.
Pushed PathsWhy(lua_State* L, LuaPaths& paths, int rank) {
  const std::shared_ptr<LuaPath> path = rank < 1 ? nullptr : FindPath(paths, rank);
  if (!path) throw InputError("", "rank", "the rank of a path", std::to_string(rank));
  return PushExplanation(L, ExplainPath(path->GetFacts()));
}

// paths[i], from 1; nil beyond the last one.
Pushed PathsItem(lua_State* L, LuaPaths& paths, int number) {
  if (number < 1 || number > kMostPaths) {
    throw InputError("", "number", "1 to 100000", std::to_string(number));
  }
  std::shared_ptr<LuaPath> path = FindPath(paths, paths.filter ? 1 : number);
  for (int i = 1, rank = 1; paths.filter && i <= number; ++i) {
    path = FindNext(L, paths, rank);
    if (!path) break;
    rank = path->path->rank + 1;
  }
  path ? PushObject(L, path) : lua_pushnil(L);
  return {1};
}

double PathsCount(LuaPaths& paths) {
  return paths.state()->paths->Count(paths.order, paths.stages);
}
int PathsStages(LuaPaths& paths) { return paths.stages; }
std::string PathsOrder(LuaPaths& paths) { return PathOrderName(paths.order); }

int PathsToString(lua_State* L) {
  const auto paths = FindObject<LuaPaths>(L, 1);
  const std::string text =
      paths ? fmt::format("Paths({:.0f} of {} stages)", PathsCount(*paths), paths->stages)
            : "Paths";
  lua_pushlstring(L, text.data(), text.size());
  return 1;
}

// One path.

Pushed PathWhy(lua_State* L, LuaPath& path) {
  return PushExplanation(L, ExplainPath(path.GetFacts()));
}

// Why it is not before another.
Pushed PathWhyNot(lua_State* L, LuaPath& path, LuaPath& other) {
  if (path.path->rank == 0 || other.path->rank == 0) {
    throw InputError("", "other", "paths that have a rank", "one that was put together by hand");
  }
  return PushExplanation(L, ExplainOrder(path.GetFacts(), other.GetFacts()));
}

void PathShot(lua_State* L, LuaPath& path, const ShotOptions& options) {
  path.Record();
  TakeShot(L, *path.cursor.session, *path.cursor.node, options);
}

int PathRank(LuaPath& path) { return path.path->rank; }
double PathValue(LuaPath& path) { return path.path->value; }
double PathRepeats(LuaPath& path) { return path.path->repeats; }
double PathScore(LuaPath& path) { return path.path->score; }
std::vector<double> PathTerms(LuaPath& path) { return path.path->terms; }
// "" before it is a step
std::string PathStepId(LuaPath& path) { return path.recorded() ? path.cursor.step_id() : ""; }
Pushed PathNodes(lua_State* L, LuaPath& path) {
  lua_createtable(L, static_cast<int>(path.path->nodes.size()), 0);
  for (std::size_t i = 0; i < path.path->nodes.size(); ++i) {
    PushNode(L,
             path.cursor.state()->graph->nodes().at(static_cast<std::size_t>(path.path->nodes[i])));
    lua_rawseti(L, -2, static_cast<lua_Integer>(i) + 1);
  }
  return {1};
}
Pushed PathSiblings(lua_State* L, LuaPath& path) {
  const bool by_hand = path.path->rank == 0;
  const std::vector<ContactPath> siblings =
      by_hand ? std::vector<ContactPath>{}
              : FindSiblings(*path.cursor.state()->graph, *path.path, kSiblings);
  lua_createtable(L, static_cast<int>(siblings.size()), 0);
  for (std::size_t i = 0; i < siblings.size(); ++i) {
    RecordWriter(L, kSibling)
        .Set("nodes", siblings[i].nodes)
        .Set("score", siblings[i].score)
        .Set("behind", path.path->score - siblings[i].score);
    lua_rawseti(L, -2, static_cast<lua_Integer>(i) + 1);
  }
  return {1};
}

int PathToString(lua_State* L) {
  const auto path = FindObject<LuaPath>(L, 1);
  std::string text = "Path";
  if (path) {
    std::string nodes;
    for (const int id : path->path->nodes)
      nodes += fmt::format("{}{}", nodes.empty() ? "" : " > ", id);
    text = fmt::format("Path({}, {}, score {:.3f})",
                       path->path->rank == 0 ? "by hand" : fmt::format("rank {}", path->path->rank),
                       nodes, path->path->score);
  }
  lua_pushlstring(L, text.data(), text.size());
  return 1;
}

}  // namespace

PathFacts LuaPath::GetFacts() const {
  if (recorded()) return std::get<PathFacts>(cursor.node->facts.details);
  nlohmann::json options = {{"rank", path->rank}};
  if (!cursor.settings.empty()) options["settings"] = cursor.settings;
  const Applied applied = cursor.session->timeline().Try(*cursor.node, Verb::kPath, options);
  return std::get<PathFacts>(applied.facts.details);
}

void LuaPath::Record() {
  if (!recorded()) cursor.Do(Verb::kPath, {{"rank", path->rank}});
}

const ClassInfo& PathsClass() {
  static const FunctionInfo item = Method<&PathsItem>("[]", "number");
  static const ClassInfo info{"Paths",
                              {
                                  Method<&PathsNext>("next"),
                                  Method<&PathsTop>("top", "count"),
                                  Query<&PathsWhy>("why", "rank"),
                              },
                              {
                                  Property<&PathsCount>("count"),
                                  Property<&PathsStages>("stages"),
                                  Property<&PathsOrder>("order"),
                              },
                              PathsToString,
                              &item};
  return info;
}

const ClassInfo& PathClass() {
  static const ClassInfo info{"Path",
                              {
                                  Method<&PathOptimize>("optimize", "options"),
                                  Query<&PathWhy>("why"),
                                  Query<&PathWhyNot>("why_not", "other"),
                                  Method<&PathShot>("shot", "options"),
                              },
                              {
                                  Property<&PathRank>("rank"),
                                  Property<&PathScore>("score"),
                                  Property<&PathValue>("value"),
                                  Property<&PathRepeats>("repeats"),
                                  Property<&PathTerms>("terms"),
                                  Property<&PathNodes>("nodes"),
                                  Property<&PathSiblings>("siblings"),
                                  Property<&PathStepId>("step_id"),
                              },
                              PathToString};
  return info;
}

std::vector<const Schema*> PathSchemas() { return {&kSibling}; }

}  // namespace pregrasp
