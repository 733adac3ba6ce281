#include <fmt/format.h>

#include <algorithm>

#include "app/core/interrupt.h"
#include "bindings/lua_grasp.h"
#include "bindings/lua_planner.h"
#include "bindings/protect.h"

namespace pregrasp {
namespace {

const Schema kMotionSummary{"MotionSummary",
                            {"frames", "failed", "loosened", "max_tip_error_mm", "min_clearance_mm",
                             "max_joint_speed", "max_wrist_speed"}};

constexpr int kMotionKib = 100;

Planning& PlanningOf(const LuaMotion& motion) { return *motion.grasp->trajectory->planning; }

void Append(lua_State* L, LuaMotion& motion, MotionState next,
            std::shared_ptr<const JournalStep> step) {
  motion.past.push_back(std::make_shared<const Moment<MotionState>>(
      Moment<MotionState>{std::move(next), std::move(step)}));
  CountMemory(L, kMotionKib);
}

// Solves the next keyframe in order; false when all are.
bool SolveNext(lua_State* L, LuaMotion& motion) {
  Planning& planning = PlanningOf(motion);
  MotionState next = motion.state();
  if (!planning.record.Time("motion", [&] { return motion.motion->SolveKeyframe(next); })) {
    return false;
  }
  const std::vector<int>& keyframes = motion.motion->task().keyframes;
  const auto key = std::find(keyframes.begin(), keyframes.end(), next.solved_keys.back());
  const int number = static_cast<int>(key - keyframes.begin()) + 1;
  auto step = planning.Record(motion.grasp->config, [&](PlanRecord& record) {
    record.AddKeyframe(*motion.motion, next, number);
  });
  Append(L, motion, std::move(next), std::move(step));
  return true;
}

// In-betweens and smoothing; the summary and motion.csv are then this motion's.
void FinishMotion(lua_State* L, LuaMotion& motion) {
  while (SolveNext(L, motion)) ThrowIfInterrupted();
  if (motion.finished()) return;
  Planning& planning = PlanningOf(motion);
  MotionState next = motion.state();
  planning.record.Time("motion", [&] { motion.motion->Finish(next); });
  const LuaGrasp& grasp = *motion.grasp;
  const LuaTrajectory& trajectory = *grasp.trajectory;
  PlanRecord& record = planning.record;
  record.ChoosePath(*trajectory.mppi, trajectory.certificate, trajectory.release, *grasp.all);
  record.ChooseGrasp(trajectory.certificate, grasp.grasp(), *grasp.lift());
  record.ChooseMotion(*motion.motion, next);
  record.Publish();
  auto step = motion.past.back()->step;
  Append(L, motion, std::move(next), std::move(step));
}

void PushFrame(lua_State* L, const LuaMotion& motion, int frame,
               std::shared_ptr<const JournalStep> step) {
  PushObject(L, std::make_shared<LuaFrame>(
                    LuaFrame{std::make_shared<const LuaMotion>(motion), frame, std::move(step)}));
}

std::shared_ptr<LuaMotion> MotionOfLoop(lua_State* L) {
  return FindObject<LuaMotion>(L, lua_upvalueindex(1));
}

// The next value of a loop's counter, from 1.
int CountLoop(lua_State* L) {
  const auto count = static_cast<int>(lua_tointeger(L, lua_upvalueindex(2))) + 1;
  lua_pushinteger(L, count);
  lua_replace(L, lua_upvalueindex(2));
  return count;
}

// `for key in m:keyframes()`: in the order of solving, each solved when its turn comes.
int NextKeyframe(lua_State* L) {
  return Protect(L, [L] {
    const Machine::Pause pause(L);
    const auto motion = MotionOfLoop(L);
    const auto count = static_cast<std::size_t>(CountLoop(L));
    if (motion->state().solved_keys.size() < count && !SolveNext(L, *motion)) return 0;
    // The moment that solved it: the first one with so many keyframes.
    for (const auto& moment : motion->past) {
      if (moment->state.solved_keys.size() != count) continue;
      PushFrame(L, *motion, moment->state.solved_keys.back(), moment->step);
      return 1;
    }
    return 0;
  });
}

// `for frame in m:frames()`: in time.
int NextFrame(lua_State* L) {
  return Protect(L, [L] {
    const Machine::Pause pause(L);
    const auto motion = MotionOfLoop(L);
    const int frame = CountLoop(L) - 1;
    FinishMotion(L, *motion);
    if (frame >= static_cast<int>(motion->state().frames.size())) return 0;
    auto step = PlanningOf(*motion).Record(motion->grasp->config, [&](PlanRecord& record) {
      record.AddFrame(*motion->motion, motion->state(), frame);
    });
    PushFrame(L, *motion, frame, std::move(step));
    return 1;
  });
}

Pushed PushLoop(lua_State* L, const std::shared_ptr<LuaMotion>& motion, lua_CFunction next) {
  PushObject(L, motion);
  lua_pushinteger(L, 0);
  lua_pushcclosure(L, next, 2);
  return {1};
}

// Methods.

Pushed MotionKeyframes(lua_State* L, const std::shared_ptr<LuaMotion>& motion) {
  return PushLoop(L, motion, NextKeyframe);
}

Pushed MotionFrames(lua_State* L, const std::shared_ptr<LuaMotion>& motion) {
  return PushLoop(L, motion, NextFrame);
}

bool MotionStep(lua_State* L, LuaMotion& motion) { return SolveNext(L, motion); }

void MotionFinish(lua_State* L, LuaMotion& motion) { FinishMotion(L, motion); }

void MotionBack(LuaMotion& motion, const std::optional<int>& steps) {
  GoBack(motion.past, steps.value_or(1));
}

void MotionShot(lua_State* L, LuaMotion& motion, const ShotOptions& options) {
  ShootStep(L, PlanningOf(motion), motion.past.back()->step, options);
}

// Properties.

bool MotionFinished(LuaMotion& motion) { return motion.finished(); }
int MotionNumKeyframes(LuaMotion& motion) {
  return static_cast<int>(motion.motion->task().keyframes.size());
}
int MotionNumSolved(LuaMotion& motion) {
  return static_cast<int>(motion.state().solved_keys.size());
}
int MotionNumFrames(LuaMotion& motion) {
  return static_cast<int>(motion.motion->task().frames.size());
}
std::string MotionOrder(LuaMotion& motion) {
  return KeyframeOrderName(motion.motion->config().order);
}
std::string MotionStepId(LuaMotion& motion) { return StepId(motion.past.back()->step); }
// nil before it is finished
Pushed MotionSummaryOf(lua_State* L, LuaMotion& motion) {
  if (!motion.finished()) {
    lua_pushnil(L);
    return {1};
  }
  const MotionSummary summary = motion.motion->Summarize(motion.state());
  RecordWriter(L, kMotionSummary)
      .Set("frames", summary.frames)
      .Set("failed", summary.failed)
      .Set("loosened", summary.loosened)
      .Set("max_tip_error_mm", 1e3 * summary.max_tip_error)
      .Set("min_clearance_mm", 1e3 * summary.min_clearance)
      .Set("max_joint_speed", summary.max_joint_speed)
      .Set("max_wrist_speed", summary.max_wrist_speed);
  return {1};
}

int MotionToString(lua_State* L) {
  const auto motion = FindObject<LuaMotion>(L, 1);
  const std::string text =
      motion ? fmt::format("Motion({} of {} keyframes{})", MotionNumSolved(*motion),
                           MotionNumKeyframes(*motion), motion->finished() ? ", finished" : "")
             : "Motion";
  lua_pushlstring(L, text.data(), text.size());
  return 1;
}

// A frame.

const MotionFrameTask& TaskOf(const LuaFrame& frame) {
  return frame.motion->motion->task().frames.at(static_cast<std::size_t>(frame.frame));
}
const MotionFrame& SolutionOf(const LuaFrame& frame) {
  return frame.motion->state().frames.at(static_cast<std::size_t>(frame.frame));
}

void FrameShot(lua_State* L, LuaFrame& frame, const ShotOptions& options) {
  ShootStep(L, PlanningOf(*frame.motion), frame.step, options);
}

int FrameNumber(LuaFrame& frame) { return frame.frame + 1; }
double FrameTime(LuaFrame& frame) { return TaskOf(frame).t; }
std::string FramePhase(LuaFrame& frame) { return MotionPhaseName(TaskOf(frame).phase); }
std::string FrameLoosened(LuaFrame& frame) { return LooseningRungName(SolutionOf(frame).rung); }
bool FrameFailed(LuaFrame& frame) { return SolutionOf(frame).rung == LooseningRung::kFailed; }
double FrameTipError(LuaFrame& frame) { return 1e3 * SolutionOf(frame).tip_error; }
double FrameClearance(LuaFrame& frame) { return 1e3 * SolutionOf(frame).clearance; }
std::string FrameStepId(LuaFrame& frame) { return StepId(frame.step); }
Pushed FramePalm(lua_State* L, LuaFrame& frame) {
  PushTransform(L, SolutionOf(frame).configuration.X_WH);
  return {1};
}
Pushed FrameJoints(lua_State* L, LuaFrame& frame) {
  PushJoints(L, SolutionOf(frame).configuration.q);
  return {1};
}
Pushed FrameObject(lua_State* L, LuaFrame& frame) {
  PushTransform(L, TaskOf(frame).X_WB.front());
  return {1};
}
std::vector<std::string> FrameTouching(LuaFrame& frame) {
  std::vector<std::string> fingers;
  for (int f = 0; f < kNumFingers; ++f) {
    if (TaskOf(frame).contacts[static_cast<std::size_t>(f)].on)
      fingers.emplace_back(kFingerNames[f]);
  }
  return fingers;
}

int FrameToString(lua_State* L) {
  const auto frame = FindObject<LuaFrame>(L, 1);
  const std::string text = frame ? fmt::format("Frame({}, t = {:.3f} s, {})", frame->frame + 1,
                                               TaskOf(*frame).t, FrameLoosened(*frame))
                                 : "Frame";
  lua_pushlstring(L, text.data(), text.size());
  return 1;
}

}  // namespace

bool LuaMotion::finished() const {
  return state().filled && state().sweeps >= motion->config().smoothing_sweeps;
}

Pushed GraspMotion(lua_State* L, const std::shared_ptr<LuaGrasp>& grasp,
                   const MotionOptions& options) {
  if (!grasp->grasp().feasible()) {
    throw InputError("", "", "a feasible grasp", GraspStatusName(grasp->grasp().result.status));
  }
  auto changed = std::make_shared<LuaGrasp>(*grasp);
  options.ApplyTo(changed->config);
  const LuaTrajectory& trajectory = *grasp->trajectory;
  const Planner planner = trajectory.planning->planner.WithConfig(changed->config);
  auto motion = std::make_shared<const HandMotion>(
      planner.MakeMotion(trajectory.certificate, grasp->grasp().result, grasp->lift()->direction_W,
                         changed->config.motion));
  Moments<MotionState> past = {std::make_shared<const Moment<MotionState>>(
      Moment<MotionState>{motion->Start(), grasp->step})};
  PushObject(L, std::make_shared<LuaMotion>(
                    LuaMotion{std::move(changed), std::move(motion), std::move(past)}));
  CountMemory(L, kMotionKib);
  return {1};
}

const ClassInfo& MotionClass() {
  static const ClassInfo info{"Motion",
                              {
                                  Method<&MotionKeyframes>("keyframes"),
                                  Method<&MotionFrames>("frames"),
                                  Method<&MotionStep>("step"),
                                  Method<&MotionFinish>("finish"),
                                  Method<&MotionBack>("back", "steps"),
                                  Method<&MotionShot>("shot", "options"),
                              },
                              {
                                  Property<&MotionFinished>("finished"),
                                  Property<&MotionNumKeyframes>("num_keyframes"),
                                  Property<&MotionNumSolved>("num_solved"),
                                  Property<&MotionNumFrames>("num_frames"),
                                  Property<&MotionOrder>("order"),
                                  Property<&MotionSummaryOf>("summary"),
                                  Property<&MotionStepId>("step_id"),
                              },
                              MotionToString};
  return info;
}

const ClassInfo& FrameClass() {
  static const ClassInfo info{"Frame",
                              {
                                  Method<&FrameShot>("shot", "options"),
                              },
                              {
                                  Property<&FrameNumber>("number"),
                                  Property<&FrameTime>("t"),
                                  Property<&FramePhase>("phase"),
                                  Property<&FrameLoosened>("loosened"),
                                  Property<&FrameFailed>("failed"),
                                  Property<&FrameTipError>("tip_error_mm"),
                                  Property<&FrameClearance>("clearance_mm"),
                                  Property<&FramePalm>("X_WH"),
                                  Property<&FrameJoints>("q"),
                                  Property<&FrameObject>("X_WO"),
                                  Property<&FrameTouching>("touching"),
                                  Property<&FrameStepId>("step_id"),
                              },
                              FrameToString};
  return info;
}

std::vector<const Schema*> MotionSchemas() { return {&kMotionSummary}; }

}  // namespace pregrasp
