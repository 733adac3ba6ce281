#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/graph/contact_path.h"
#include "app/pipeline/plan_record.h"
#include "bindings/lua_session.h"
#include "bindings/planner_options.h"

namespace pregrasp {

// The planner's stages as scripts hold them. Each object keeps all states that it went through, as
// values that are never changed: going back drops the last ones, a fork shares them.

/// What the stages of one session share.
struct Planning {
  Planning(std::shared_ptr<Session> session, const PlannerConfig& config,
           const std::filesystem::path& weights);

  /// That of the session, made with the first stage. @param config  its settings.
  static std::shared_ptr<Planning> Of(lua_State* L, const std::shared_ptr<Session>& session,
                                      const PlannerConfig& config);

  /// Records what `add` adds, as made with `config`. @returns the step.
  template <typename Add>
  std::shared_ptr<const JournalStep> Record(const PlannerConfig& config, Add&& add) {
    record.SetConfig(config);
    add(record);
    record.Publish();
    return std::make_shared<const JournalStep>(session->last_step());
  }

  std::shared_ptr<Session> session;
  WorldState start;
  Planner planner;
  PlanRecord record;
};

/// A state with the step that recorded it.
template <typename State>
struct Moment {
  State state;
  std::shared_ptr<const JournalStep> step;
};
template <typename State>
using Moments = std::vector<std::shared_ptr<const Moment<State>>>;

/// Drops the last `steps` moments, all but the first at most. @throws InputError for more.
template <typename State>
void GoBack(Moments<State>& moments, int steps) {
  const int most = static_cast<int>(moments.size()) - 1;
  if (steps < 0 || steps > most) {
    throw InputError("", "steps", "0 to " + std::to_string(most) + " steps", std::to_string(steps));
  }
  moments.resize(moments.size() - static_cast<std::size_t>(steps));
}

struct LuaGraph {
  std::shared_ptr<Planning> planning;
  PlannerConfig config;
  Moments<ContactGraph> past;

  const ContactGraph& graph() const { return past.back()->state; }
};

struct LuaReason {
  NodeReason reason;
};

/// Paths in their order, each found when it is first asked for.
struct LuaPaths {
  std::shared_ptr<Planning> planning;
  PlannerConfig config;
  std::shared_ptr<const Moment<ContactGraph>> graph;
  PathSearch search;
  std::vector<ContactPath> found;
  std::size_t next = 0;  // that next() gives
};

struct LuaPath {
  std::shared_ptr<Planning> planning;
  PlannerConfig config;
  std::shared_ptr<const Moment<ContactGraph>> graph;
  ContactPath path;
  std::shared_ptr<const JournalStep> step;  // null until it is recorded
};

struct LuaOptimizer {
  std::shared_ptr<Planning> planning;
  PlannerConfig config;
  std::shared_ptr<const Moment<ContactGraph>> graph;  // that mppi refers to
  std::shared_ptr<const Mppi> mppi;
  Moments<MppiState> past;

  const MppiState& state() const { return past.back()->state; }
};

struct LuaTrajectory {
  std::shared_ptr<Planning> planning;
  PlannerConfig config;
  std::shared_ptr<const Moment<ContactGraph>> graph;
  std::shared_ptr<const Mppi> mppi;
  Certificate certificate;
  ReleaseResult release;
  std::shared_ptr<const JournalStep> step;

  int path_rank() const { return mppi->problem().path.rank; }
};

struct LuaGrasp {
  std::shared_ptr<const LuaTrajectory> trajectory;
  PlannerConfig config;
  std::shared_ptr<const GraspSet> all;
  int sample = 0;
  std::shared_ptr<const JournalStep> step;

  const CompletedGrasp& grasp() const { return all->grasps[static_cast<std::size_t>(sample)]; }
  const std::optional<LiftResult>& lift() const {
    return all->lifts[static_cast<std::size_t>(sample)];
  }
};

struct LuaGrasps {
  std::shared_ptr<const GraspSet> all;
  std::vector<std::shared_ptr<LuaGrasp>> grasps;  // by sample
};

struct LuaMotion {
  std::shared_ptr<const LuaGrasp> grasp;
  std::shared_ptr<const HandMotion> motion;
  Moments<MotionState> past;

  const MotionState& state() const { return past.back()->state; }
  bool finished() const;
};

struct LuaFrame {
  std::shared_ptr<const LuaMotion> motion;  // as it was when the frame was made
  int frame = 0;
  std::shared_ptr<const JournalStep> step;
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

template <>
struct LuaClass<LuaGraph> {
  static const ClassInfo& info() { return GraphClass(); }
};
template <>
struct LuaClass<LuaReason> {
  static const ClassInfo& info() { return ReasonClass(); }
};
template <>
struct LuaClass<LuaPaths> {
  static const ClassInfo& info() { return PathsClass(); }
};
template <>
struct LuaClass<LuaPath> {
  static const ClassInfo& info() { return PathClass(); }
};
template <>
struct LuaClass<LuaOptimizer> {
  static const ClassInfo& info() { return OptimizerClass(); }
};
template <>
struct LuaClass<LuaTrajectory> {
  static const ClassInfo& info() { return TrajectoryClass(); }
};
template <>
struct LuaClass<LuaGrasps> {
  static const ClassInfo& info() { return GraspsClass(); }
};
template <>
struct LuaClass<LuaGrasp> {
  static const ClassInfo& info() { return GraspClass(); }
};
template <>
struct LuaClass<LuaMotion> {
  static const ClassInfo& info() { return MotionClass(); }
};
template <>
struct LuaClass<LuaFrame> {
  static const ClassInfo& info() { return FrameClass(); }
};

/// graph{..} of a session.
Pushed SessionGraph(lua_State* L, const std::shared_ptr<Session>& session,
                    const GraphOptions& options);

// What one stage gives to the next.
Pushed PathOptimize(lua_State* L, LuaPath& path, const OptimizeOptions& options);
Pushed TrajectoryGrasps(lua_State* L, const std::shared_ptr<LuaTrajectory>& trajectory,
                        const GraspsOptions& options);
Pushed GraspMotion(lua_State* L, const std::shared_ptr<LuaGrasp>& grasp,
                   const MotionOptions& options);

/// shot{..} of something that a step recorded. @throws InputError if none did yet.
void ShootStep(lua_State* L, const Planning& planning,
               const std::shared_ptr<const JournalStep>& step, const ShotOptions& options);

/// The id of a step, "" for none.
std::string StepId(const std::shared_ptr<const JournalStep>& step);

/// Calls ipairs on the list on top.
Pushed PushIpairs(lua_State* L);

std::vector<const Schema*> GraphSchemas();
std::vector<const Schema*> TrajectorySchemas();
std::vector<const Schema*> GraspStageSchemas();
std::vector<const Schema*> MotionSchemas();
std::vector<const ClassInfo*> PlannerClasses();

}  // namespace pregrasp
