#include <fmt/format.h>

#include <algorithm>

#include "app/core/interrupt.h"
#include "bindings/lua_grasp.h"
#include "bindings/lua_planner.h"
#include "bindings/protect.h"

namespace pregrasp {
namespace {

const Schema kMotionSummary{
    "MotionSummary",
    {"frames", "failed", "blocked_ways", "loosened", "max_tip_error_mm", "min_clearance_mm",
     "max_joint_speed", "max_wrist_speed", "forearm_free", "over_limits"}};

bool IsFinished(const LuaMotion& motion) {
  const auto state = motion.begun();
  return state && state->motion_state->finished;
}

int NumSolved(const LuaMotion& motion) {
  const auto state = motion.begun();
  return state ? static_cast<int>(state->motion_state->solved_keys.size()) : 0;
}

// Solves the next keyframe in order; false when all are.
bool SolveNext(lua_State* L, LuaMotion& motion) {
  const auto state = motion.begun();
  if (state && state->motion_state->solved_keys.size() == state->motion_state->keys.size()) {
    return false;
  }
  motion.SolveKeyframe();
  CountSteps(L, *motion.session);
  return true;
}

// In-betweens and smoothing.
void FinishMotion(lua_State* L, LuaMotion& motion) {
  if (IsFinished(motion)) return;
  while (SolveNext(L, motion)) ThrowIfInterrupted();
  motion.node = &pregrasp::FinishMotion(motion.session->timeline(), *motion.node);
  CountSteps(L, *motion.session);
}

void PushFrame(lua_State* L, const LuaMotion& motion, const Timeline::Node* node) {
  PushObject(L, std::make_shared<LuaFrame>(LuaFrame{motion.session, node}));
}

// The step of the keyframe that was solved as number `count`, from 1.
const Timeline::Node* FindKeyframe(const LuaMotion& motion, int count) {
  std::vector<const Timeline::Node*> solved;
  for (const Timeline::Node* at = motion.node; at != motion.first; at = at->parent) {
    if (at->command.verb == Verb::kKeyframe) solved.push_back(at);
  }
  return count > static_cast<int>(solved.size()) ? nullptr : solved[solved.size() - count];
}

std::shared_ptr<LuaMotion> MotionOfLoop(lua_State* L) {
  auto motion = LuaValue<std::shared_ptr<LuaMotion>>::Read(L, lua_upvalueindex(1), "");
  RequireNotAsking(L, motion->session.get());
  return motion;
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
    const int count = CountLoop(L);
    if (NumSolved(*motion) < count && !SolveNext(L, *motion)) return 0;
    const Timeline::Node* keyframe = FindKeyframe(*motion, count);
    if (keyframe == nullptr) return 0;
    PushFrame(L, *motion, keyframe);
    return 1;
  });
}

// `for frame in m:frames()`: in time.
int NextFrame(lua_State* L) {
  return Protect(L, [L] {
    const Machine::Pause pause(L);
    const auto motion = MotionOfLoop(L);
    const int frame = CountLoop(L);
    FinishMotion(L, *motion);
    if (frame > static_cast<int>(motion->state()->motion_state->frames.size())) return 0;
    PushFrame(L, *motion,
              &motion->session->timeline().Do(*motion->node, Verb::kFrame, {{"frame", frame}}));
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
  motion.Back(steps.value_or(1), motion.first);
}

void MotionForward(LuaMotion& motion, const std::optional<int>& steps) {
  motion.Forward(steps.value_or(1));
}

Pushed MotionWhy(lua_State* L, LuaMotion& motion) {
  if (const auto* facts = std::get_if<MotionFacts>(&motion.node->facts.details)) {
    return PushExplanation(L, ExplainMotionEnd(*facts));
  }
  const auto* keyframe = std::get_if<FrameFacts>(&motion.node->facts.details);
  if (keyframe == nullptr) {
    throw InputError("", "", "a motion with a keyframe", "one before its first step()");
  }
  return PushExplanation(L, ExplainFrame(*keyframe, motion.state()->config.motion));
}

Pushed MotionWhyNot(lua_State* L, LuaMotion& motion, LuaMotion& other) {
  const auto* facts = std::get_if<MotionFacts>(&motion.node->facts.details);
  const auto* against = std::get_if<MotionFacts>(&other.node->facts.details);
  if (facts == nullptr || against == nullptr) {
    throw InputError("", "", "two motions that are finished", "one that is not");
  }
  return PushExplanation(L, ExplainMotionAgainst(*facts, *against));
}

void MotionShot(lua_State* L, LuaMotion& motion, const ShotOptions& options) {
  TakeShot(L, *motion.session, *motion.node, options);
}

// Properties.

bool MotionFinished(LuaMotion& motion) { return IsFinished(motion); }
int MotionNumKeyframes(LuaMotion& motion) {
  return static_cast<int>(motion.GetTask().keyframes.size());
}
int MotionNumSolved(LuaMotion& motion) { return NumSolved(motion); }
int MotionNumFrames(LuaMotion& motion) { return static_cast<int>(motion.GetTask().frames.size()); }
std::string MotionOrder(LuaMotion& motion) {
  const auto order = motion.settings.find("motion.order");
  if (order != motion.settings.end()) return order->get<std::string>();
  return KeyframeOrderName(motion.state()->config.motion.order);
}
std::string MotionStepId(LuaMotion& motion) { return motion.step_id(); }
// nil before it is finished
Pushed MotionSummaryOf(lua_State* L, LuaMotion& motion) {
  if (!IsFinished(motion)) {
    lua_pushnil(L);
    return {1};
  }
  const auto state = motion.state();
  const MotionSummary summary = state->motion->Summarize(*state->motion_state);
  RecordWriter(L, kMotionSummary)
      .Set("frames", summary.frames)
      .Set("failed", summary.failed)
      .Set("blocked_ways", summary.blocked_ways)
      .Set("loosened", summary.loosened)
      .Set("max_tip_error_mm", 1e3 * summary.max_tip_error)
      .Set("min_clearance_mm", 1e3 * summary.min_clearance)
      .Set("max_joint_speed", summary.rates.joint_speed)
      .Set("max_wrist_speed", summary.rates.wrist_speed)
      .Set("forearm_free", IsForearmFree(state->planner->forearm(), *state->motion_state))
      .Set("over_limits", summary.over_limits);
  return {1};
}

int MotionToString(lua_State* L) {
  const auto motion = FindObject<LuaMotion>(L, 1);
  const std::string text = motion ? fmt::format("Motion({} keyframes{})", MotionNumSolved(*motion),
                                                MotionFinished(*motion) ? ", finished" : "")
                                  : "Motion";
  lua_pushlstring(L, text.data(), text.size());
  return 1;
}

// A frame.

Pushed FrameWhy(lua_State* L, LuaFrame& frame) {
  return PushExplanation(
      L,
      ExplainFrame(frame.facts(), frame.session->timeline().GetState(*frame.node)->config.motion));
}

Pushed FrameWhyNot(lua_State* L, LuaFrame& frame, LuaFrame& other) {
  return PushExplanation(
      L, ExplainFrameAgainst(frame.facts(), other.facts(),
                             frame.session->timeline().GetState(*frame.node)->config.motion));
}

void FrameShot(lua_State* L, LuaFrame& frame, const ShotOptions& options) {
  TakeShot(L, *frame.session, *frame.node, options);
}

int FrameNumber(LuaFrame& frame) { return frame.facts().frame; }
double FrameTime(LuaFrame& frame) { return frame.node->facts.t; }
double FrameSimulatedTime(LuaFrame& frame) { return frame.facts().simulated_t; }
std::string FramePhase(LuaFrame& frame) { return frame.facts().phase; }
std::string FrameLoosened(LuaFrame& frame) { return frame.facts().loosened; }
bool FrameFailed(LuaFrame& frame) { return frame.facts().failed; }
bool FrameWayClear(LuaFrame& frame) { return frame.facts().way_clear; }
double FrameTipError(LuaFrame& frame) { return frame.facts().tip_error_mm; }
double FrameClearance(LuaFrame& frame) { return frame.facts().clearance_mm; }
std::string FrameStepId(LuaFrame& frame) { return frame.node->id(); }
Pushed FramePalm(lua_State* L, LuaFrame& frame) {
  PushTransform(L, frame.facts().hand.configuration().X_WH);
  return {1};
}
Pushed FrameJoints(lua_State* L, LuaFrame& frame) {
  PushJoints(L, frame.session->job().hand(), frame.facts().hand.configuration().q);
  return {1};
}
Pushed FrameObject(lua_State* L, LuaFrame& frame) {
  PushTransform(L, frame.node->facts.object().X_WB());
  return {1};
}
std::vector<std::string> FrameTouching(LuaFrame& frame) {
  std::vector<std::string> fingers;
  for (const PlaceFacts& place : frame.facts().touching) {
    fingers.emplace_back(FingerName(place.finger));
  }
  return fingers;
}

int FrameToString(lua_State* L) {
  const auto frame = FindObject<LuaFrame>(L, 1);
  const std::string text = frame ? fmt::format("Frame({}, t = {:.3f} s, {})", FrameNumber(*frame),
                                               FrameTime(*frame), FrameLoosened(*frame))
                                 : "Frame";
  lua_pushlstring(L, text.data(), text.size());
  return 1;
}

}  // namespace

MotionTask LuaMotion::GetTask() const {
  if (const auto state = begun()) return *state->motion_state->task;
  const auto state = this->state();
  PlannerConfig config = state->config;
  ApplySettings(settings, config);
  const Planner planner = state->planner->WithConfig(config);
  const auto number = static_cast<std::size_t>(grasp);
  return planner
      .MakeMotion(*state->certificate, state->grasps->grasps[number - 1].result,
                  *state->lifts.at(grasp), config.motion)
      .task();
}

void LuaMotion::SolveKeyframe() {
  Do(Verb::kKeyframe, node == first ? nlohmann::json{{"grasp", grasp}} : nlohmann::json::object());
}

Pushed GraspMotion(lua_State* L, LuaGrasp& grasp, const MotionOptions& options) {
  if (!grasp.facts().feasible) throw InputError("", "", "a feasible grasp", grasp.facts().status);
  PushObject(L, std::make_shared<LuaMotion>(
                    LuaMotion{{grasp.all.session, grasp.all.node, options.ToSettings()},
                              grasp.all.node,
                              grasp.entry()}));
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
                                  Method<&MotionForward>("forward", "steps"),
                                  Query<&MotionWhy>("why"),
                                  Query<&MotionWhyNot>("why_not", "other"),
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
                                  Query<&FrameWhy>("why"),
                                  Query<&FrameWhyNot>("why_not", "other"),
                                  Method<&FrameShot>("shot", "options"),
                              },
                              {
                                  Property<&FrameNumber>("number"),
                                  Property<&FrameTime>("t"),
                                  Property<&FrameSimulatedTime>("simulated_t"),
                                  Property<&FramePhase>("phase"),
                                  Property<&FrameLoosened>("loosened"),
                                  Property<&FrameFailed>("failed"),
                                  Property<&FrameWayClear>("way_clear"),
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
