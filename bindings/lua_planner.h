#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/graph/contact_path.h"
#include "app/job/run_steps.h"
#include "app/pictures/reasons.h"
#include "bindings/lua_array.h"
#include "bindings/lua_session.h"
#include "bindings/planner_options.h"

namespace pregrasp {

// The planner's stages as scripts hold them: cursors into the session's timeline. Doing something
// moves an object on, going back moves it to an earlier step, a fork is another cursor at the same
// one.

/// A place in a session's timeline.
struct Cursor {
  std::shared_ptr<Session> session;
  const Timeline::Node* node = nullptr;
  /// Of the next command: fields of the planner's configuration by full name.
  nlohmann::json settings = nlohmann::json::object();
  /// Where it came from when it went back: a step after `node`, or `node`, or on another branch.
  const Timeline::Node* ahead = nullptr;

  std::shared_ptr<const JobState> state() const { return session->timeline().GetState(*node); }
  const std::string& step_id() const { return node->id(); }

  /// The command's options with the settings in them, which are then used up.
  nlohmann::json TakeOptions(nlohmann::json options = nlohmann::json::object());
  void Do(Verb verb, nlohmann::json options = nlohmann::json::object());
  /// Moves to the node `steps` before this one. @throws InputError beyond `first`.
  void Back(int steps, const Timeline::Node* first);
  /// Moves to the node `steps` after this one, on the way to where it was before it went back.
  /// @throws InputError beyond that.
  void Forward(int steps);
};

struct LuaGraph : Cursor {
  const Timeline::Node* first = nullptr;  ///< graph.mesh

  std::shared_ptr<const ContactGraph> graph() const { return state()->graph; }
};

struct LuaReason {
  NodeReason reason;
};

/// Any object that has a place in a timeline: what pg.compare and save_state take.
struct AnyPlace {
  std::shared_ptr<Session> session;
  const Timeline::Node* node = nullptr;
};
template <>
struct LuaValue<AnyPlace> {
  static AnyPlace Read(lua_State* L, int index, const std::string& path);
};

/// Paths in their order, each found when it is first asked for; the cursor is at the graph.
struct LuaPaths : Cursor {
  PathOrder order = PathOrder::kExplore;
  int stages = 0;
  int next = 1;  ///< the rank that next() asks for first
  std::shared_ptr<const FunctionReference> filter = nullptr;  ///< null: all paths count
};

struct LuaPath {
  Cursor cursor;  ///< at the graph, or at the path's own step once it is one
  std::shared_ptr<const ContactPath> path;

  bool recorded() const { return cursor.node->command.verb == Verb::kPath; }
  void Record();
  /// What a step of it says, whether it is one or not.
  PathFacts GetFacts() const;
};

struct LuaOptimizer : Cursor {
  const Timeline::Node* first = nullptr;  ///< paths.rank.P
  int nominal = 0;  ///< of the next iteration: a rollout, from 1; 0 for the mean

  int path_rank() const { return std::get<PathFacts>(first->facts.details).rank; }
  /// Null before the first iteration.
  const IterationFacts* facts() const { return std::get_if<IterationFacts>(&node->facts.details); }
};

struct LuaTrajectory : Cursor {
  const CertifyFacts& facts() const { return std::get<CertifyFacts>(node->facts.details); }
};

/// All grasps of a trajectory; the cursor is after their lifts.
struct LuaGrasps : Cursor {
  std::vector<std::shared_ptr<struct LuaGrasp>> grasps;  ///< by number
};

struct LuaGrasp {
  Cursor all;                            ///< after the lifts of all grasps
  const Timeline::Node* step = nullptr;  ///< its own
  const Timeline::Node* lift = nullptr;  ///< null if it was not lifted

  const GraspFacts& facts() const { return std::get<GraspFacts>(step->facts.details); }
  int entry() const { return facts().entry; }
  const CompletedGrasp& grasp(const JobState& state) const {
    return state.grasps->grasps[static_cast<std::size_t>(entry()) - 1];
  }
};

struct LuaMotion : Cursor {
  const Timeline::Node* first = nullptr;  ///< before its first keyframe
  int grasp = 0;                          ///< that it ends in
  /// What it has come to; null before the first keyframe.
  std::shared_ptr<const JobState> begun() const { return node == first ? nullptr : state(); }
  /// Its task, before the first keyframe too.
  MotionTask GetTask() const;
  void SolveKeyframe();
};

/// A whole run, taken step by step.
struct LuaPlan {
  std::shared_ptr<Session> session;
  RunConfig config;
  RunPlace place;  ///< of which `steps` are taken
  int ahead = 0;   ///< steps that were taken before it went back
};

/// A step that shows a frame.
struct LuaFrame {
  std::shared_ptr<Session> session;
  const Timeline::Node* node = nullptr;

  const FrameFacts& facts() const { return std::get<FrameFacts>(node->facts.details); }
};

const ClassInfo& GraphClass();
const ClassInfo& ReasonClass();
const ClassInfo& PathsClass();
const ClassInfo& PathClass();
const ClassInfo& OptimizerClass();
const ClassInfo& TrajectoryClass();
const ClassInfo& GraspsClass();
const ClassInfo& GraspClass();
const ClassInfo& MotionClass();
const ClassInfo& FrameClass();
const ClassInfo& PlanClass();

template <>
struct LuaClass<LuaGraph> {
  static const ClassInfo& info() { return GraphClass(); }
  static const Session* session(const LuaGraph& object) { return object.session.get(); }
};
template <>
struct LuaClass<LuaReason> {
  static const ClassInfo& info() { return ReasonClass(); }
  static const Session* session(const LuaReason& /*object*/) { return nullptr; }
};
template <>
struct LuaClass<LuaPaths> {
  static const ClassInfo& info() { return PathsClass(); }
  static const Session* session(const LuaPaths& object) { return object.session.get(); }
};
template <>
struct LuaClass<LuaPath> {
  static const ClassInfo& info() { return PathClass(); }
  static const Session* session(const LuaPath& object) { return object.cursor.session.get(); }
};
template <>
struct LuaClass<LuaOptimizer> {
  static const ClassInfo& info() { return OptimizerClass(); }
  static const Session* session(const LuaOptimizer& object) { return object.session.get(); }
};
template <>
struct LuaClass<LuaTrajectory> {
  static const ClassInfo& info() { return TrajectoryClass(); }
  static const Session* session(const LuaTrajectory& object) { return object.session.get(); }
};
template <>
struct LuaClass<LuaGrasps> {
  static const ClassInfo& info() { return GraspsClass(); }
  static const Session* session(const LuaGrasps& object) { return object.session.get(); }
};
template <>
struct LuaClass<LuaGrasp> {
  static const ClassInfo& info() { return GraspClass(); }
  static const Session* session(const LuaGrasp& object) { return object.all.session.get(); }
};
template <>
struct LuaClass<LuaMotion> {
  static const ClassInfo& info() { return MotionClass(); }
  static const Session* session(const LuaMotion& object) { return object.session.get(); }
};
template <>
struct LuaClass<LuaPlan> {
  static const ClassInfo& info() { return PlanClass(); }
  static const Session* session(const LuaPlan& object) { return object.session.get(); }
};
template <>
struct LuaClass<LuaFrame> {
  static const ClassInfo& info() { return FrameClass(); }
  static const Session* session(const LuaFrame& object) { return object.session.get(); }
};

/// graph{..} of a session.
Pushed SessionGraph(lua_State* L, const std::shared_ptr<Session>& session,
                    const GraphOptions& options);

// What one stage gives to the next.
Pushed PathOptimize(lua_State* L, LuaPath& path, const OptimizeOptions& options);
Pushed TrajectoryGrasps(lua_State* L, LuaTrajectory& trajectory, const GraspsOptions& options);
Pushed GraspMotion(lua_State* L, LuaGrasp& grasp, const MotionOptions& options);

/// A contact state of a graph, as a record.
void PushNode(lua_State* L, const ContactNode& node);
void PushNeighbours(lua_State* L, const NeighbourFacts& facts);
void PushCost(lua_State* L, const CostFacts& cost);

/// A sentence with the numbers that it is made of.
Pushed PushExplanation(lua_State* L, const Explanation& why);

// What an optimiser's iteration did (lua_rollouts.cc).
LuaArray OptimizerRollouts(LuaOptimizer& optimizer);
Pushed OptimizerElite(lua_State* L, LuaOptimizer& optimizer, const std::optional<int>& count);
Pushed OptimizerRollout(lua_State* L, LuaOptimizer& optimizer, int number);
LuaArray OptimizerTrace(lua_State* L, LuaOptimizer& optimizer, const std::optional<int>& number,
                        const std::optional<int>& every);
LuaArray TrajectoryTrace(lua_State* L, LuaTrajectory& trajectory, const std::optional<int>& every);
Pushed OptimizerWhy(lua_State* L, LuaOptimizer& optimizer, const std::optional<int>& number);
Pushed OptimizerWhyNot(lua_State* L, LuaOptimizer& optimizer, int number,
                       const std::optional<int>& other);
Pushed OptimizerNominal(lua_State* L, LuaOptimizer& optimizer);
Pushed OptimizerPlans(lua_State* L, LuaOptimizer& optimizer);
Pushed OptimizerSettings(lua_State* L, LuaOptimizer& optimizer);
double OptimizerSigma(LuaOptimizer& optimizer);

// Going about in time (lua_timeline.cc).
Pushed SessionGo(lua_State* L, const std::shared_ptr<Session>& session, const std::string& id);
Pushed SessionStep(lua_State* L, Session& session, const std::string& id);
std::vector<std::string> SessionIds(Session& session);
std::string SessionSaveState(lua_State* L, const std::shared_ptr<Session>& session,
                             const std::string& dir, const std::optional<AnyPlace>& at);
Pushed SessionWhy(lua_State* L, const std::shared_ptr<Session>& session);
Pushed SessionWhyNot(lua_State* L, Session& session, int path);
/// @throws InputError for what is no path's rank.
void RequireRank(int path);
/// The finished grasps of the certificate that a node follows, as trajectory:grasps{} gives them.
std::shared_ptr<LuaGrasps> FindGrasps(const std::shared_ptr<Session>& session,
                                      const Timeline::Node& certified, nlohmann::json options);

// The same in another scene (lua_what_if.cc).
struct WhatIfOptions {
  std::vector<Setting> settings;
};
template <>
struct LuaValue<WhatIfOptions> {
  static WhatIfOptions Read(lua_State* L, int index, const std::string& path);
};
Pushed SessionWhatIf(lua_State* L, const std::shared_ptr<Session>& session,
                     const WhatIfOptions& options);
Pushed GraphWhatIf(lua_State* L, LuaGraph& graph, const WhatIfOptions& options);
Pushed SimulationWhatIf(lua_State* L, LuaSimulation& simulation, const WhatIfOptions& options);

/// plan{..} of a session.
struct PlanOptions {
  RunConfig config;
};
template <>
struct LuaValue<PlanOptions> {
  static PlanOptions Read(lua_State* L, int index, const std::string& path);
};
Pushed SessionPlan(lua_State* L, const std::shared_ptr<Session>& session,
                   const PlanOptions& options);

/// set = { ["object.mass"] = 0.2, .. } of `fields`, by name.
std::vector<Setting> ReadSettings(lua_State* L, const Fields& fields);

/// Functions of the module: compare, load_state.
const std::vector<FunctionInfo>& TimelineFunctions();

/// Calls ipairs on the list on top.
Pushed PushIpairs(lua_State* L);

std::vector<const Schema*> GraphSchemas();
std::vector<const Schema*> PathSchemas();
std::vector<const Schema*> TrajectorySchemas();
std::vector<const Schema*> GraspStageSchemas();
std::vector<const Schema*> MotionSchemas();
std::vector<const Schema*> ReasonSchemas();
std::vector<const Schema*> RolloutSchemas();
std::vector<const Schema*> TimelineSchemas();
std::vector<const Schema*> WhatIfSchemas();
std::vector<const Schema*> PlanSchemas();
std::vector<const ClassInfo*> PlannerClasses();

}  // namespace pregrasp
