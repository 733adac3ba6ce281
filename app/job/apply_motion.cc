#include <fmt/format.h>

#include <algorithm>

#include "app/core/check.h"
#include "app/core/error.h"
#include "app/job/apply_stages.h"

namespace pregrasp::internal {
namespace {

// The simulated row that a frame shows: of the certified trajectory, then of the lift.
const TraceRow& RowOfFrame(const JobState& state, const MotionFrameTask& task) {
  const std::vector<TraceRow>& plan = state.certificate->trace;
  const std::vector<TraceRow>& lift = state.lifts.at(state.chosen_grasp)->trace;
  const std::vector<TraceRow>& rows = task.simulated_t <= plan.back().state.t ? plan : lift;
  const auto row = std::lower_bound(rows.begin(), rows.end(), task.simulated_t,
                                    [](const TraceRow& one, double t) { return one.state.t < t; });
  PREGRASP_CHECK(row != rows.end() && row->state.t == task.simulated_t, task.simulated_t);
  return *row;
}

// The world at a frame: the bodies where the simulation has them, of its fingers those that the
// hand has on.
WorldState StateOfFrame(const TraceRow& row, const MotionFrameTask& task) {
  WorldState state = row.state;
  state.t = task.t;
  const RigidTransform X_WO = state.bodies.front().X_WB();
  for (int f = 0; f < kNumFingers; ++f) {
    const Placement::Contact& contact = task.contacts[f];
    FingertipState& tip = state.fingers[f];
    if (contact.on && tip.on) continue;
    tip = {};  // lifted, or put on at the end of this step
    tip.on = tip.touching = contact.on;
    if (!contact.on) continue;
    tip.p_OC = contact.p_OC;
    tip.nhat_O = contact.nhat_O;
    tip.p_WF = tip.p_WTarget = X_WO * contact.p_OC;
  }
  return state;
}

void SetFrameFacts(Application& a, const MotionFrameTask& task, const MotionFrame& solved,
                   int frame, int keyframe) {
  const TraceRow& row = RowOfFrame(a.next, task);
  SetWorldFacts(a.facts, a.job.world(), StateOfFrame(row, task), row.contacts);
  FrameFacts facts;
  facts.path = a.next.path->rank;
  facts.grasp = a.next.chosen_grasp;
  facts.frame = frame + 1;
  facts.keyframe = keyframe + 1;
  facts.phase = MotionPhaseName(task.phase);
  facts.loosened = LooseningRungName(solved.failed() ? LooseningRung::kFailed : solved.rung);
  facts.failed = solved.failed();
  facts.way_clear = solved.way_clear;
  facts.tip_error_mm = 1e3 * solved.tip_error;
  facts.clearance_mm = 1e3 * solved.clearance;
  facts.simulated_t = task.simulated_t;
  facts.hand = MakeHandFacts(a.job.hand(), solved.configuration);
  for (int f = 0; f < kNumFingers; ++f) {
    const Placement::Contact& contact = task.contacts[f];
    if (contact.on) {
      facts.touching.push_back({static_cast<Finger>(f), contact.p_OC, contact.nhat_O});
    }
  }
  a.facts.details = std::move(facts);
}

// The motion that ends in the grasp that the command names.
void Begin(Application& a) {
  const int number = CommandOptions(a.command).Int("grasp");
  const auto lift = a.next.lifts.find(number);
  Require(lift != a.next.lifts.end() && lift->second->simulated, "a grasp whose lift was simulated",
          "another");
  const Planner planner = a.next.planner->WithConfig(a.next.config);
  const auto motion = std::make_shared<const HandMotion>(
      planner.MakeMotion(*a.next.certificate, a.next.grasps->grasps[number - 1].result,
                         *lift->second, a.next.config.motion));
  a.next.chosen_grasp = number;
  a.next.motion = motion;
  a.next.motion_state = std::make_shared<const MotionState>(motion->Start());
}

void SolveKeyframe(Application& a) {
  if (a.command.options.contains("grasp")) {
    Require(!a.next.motion, "a motion that has not begun", "one that has");
    Begin(a);
  }
  Require(a.next.motion != nullptr, "the grasp that the motion ends in", "none");
  MotionState state = *a.next.motion_state;
  Require(a.next.motion->SolveKeyframe(state), "a keyframe that is left", "none");
  const int key = state.solved_keys.back();
  const int frame = state.task->keyframes[key];
  SetFrameFacts(a, state.task->frames[frame], state.keys[key], frame, key);
  a.next.motion_state = std::make_shared<const MotionState>(std::move(state));
  a.facts.id = fmt::format("motion.key.{}", key + 1);
}

RatesFacts MakeRatesFacts(const char* phase, const HandRates& rates) {
  return {phase,
          rates.joint_speed,
          rates.wrist_speed,
          rates.wrist_turn_speed,
          rates.joint_acceleration,
          rates.wrist_acceleration,
          rates.wrist_turn_acceleration,
          rates.speed_share,
          rates.acceleration_share};
}

void SetMotionFacts(Application& a) {
  const MotionSummary summary = a.next.motion->Summarize(*a.next.motion_state);
  MotionFacts facts;
  facts.path = a.next.path->rank;
  facts.grasp = a.next.chosen_grasp;
  facts.frames = summary.frames;
  facts.failed = summary.failed;
  facts.loosened = summary.loosened;
  facts.max_tip_error_mm = 1e3 * summary.max_tip_error;
  facts.min_clearance_mm = 1e3 * summary.min_clearance;
  facts.blocked_ways = summary.blocked_ways;
  facts.seconds = a.next.motion_state->task->frames.back().t;
  facts.forearm_free = IsForearmFree(a.next.planner->forearm(), *a.next.motion_state);
  facts.over_limits = summary.over_limits;
  facts.rates = MakeRatesFacts("whole", summary.rates);
  for (int phase = 0; phase < kNumMotionPhases; ++phase) {
    facts.phases.push_back(MakeRatesFacts(MotionPhaseName(static_cast<MotionPhase>(phase)),
                                          summary.phase_rates[phase]));
  }
  for (const DetourKind kind : a.next.motion_state->detours) {
    facts.ways.emplace_back(DetourKindName(kind));
  }
  facts.order = KeyframeOrderName(a.next.motion->config().order);
  a.facts.details = std::move(facts);
}

void Fill(Application& a) {
  Require(
      a.next.motion && a.next.motion_state->solved_keys.size() == a.next.motion_state->keys.size(),
      "a motion with all keyframes", "one without");
  Require(!a.next.motion_state->filled, "a motion without its in-betweens", "one with them");
  MotionState state = *a.next.motion_state;
  a.next.motion->FillInBetweens(state);
  a.next.motion_state = std::make_shared<const MotionState>(std::move(state));
  a.facts.id = "motion.fill";
  SetMotionFacts(a);
}

void Smooth(Application& a) {
  Require(a.next.motion && a.next.motion_state->filled, "a motion with its in-betweens",
          "one without");
  Require(!a.next.motion_state->finished, "a motion that is not smoothed", "one that is");
  MotionState state = *a.next.motion_state;
  a.next.motion->Finish(state);
  a.next.motion_state = std::make_shared<const MotionState>(std::move(state));
  a.facts.id = "motion.smooth";
  SetMotionFacts(a);
}

void ShowFrame(Application& a) {
  Require(a.next.motion && a.next.motion_state->filled, "a finished motion", "one that is not");
  const int frame = CommandOptions(a.command).Int("frame");
  const int count = static_cast<int>(a.next.motion_state->frames.size());
  if (frame < 1 || frame > count) {
    throw InputError("", "frame", fmt::format("1 to {}", count), std::to_string(frame));
  }
  a.facts.id = fmt::format("motion.frame.{}", frame);
  const std::vector<int>& keyframes = a.next.motion_state->task->keyframes;
  const auto key = std::find(keyframes.begin(), keyframes.end(), frame - 1);
  SetFrameFacts(a, a.next.motion_state->task->frames[frame - 1],
                a.next.motion_state->frames[frame - 1], frame - 1,
                key == keyframes.end() ? -1 : static_cast<int>(key - keyframes.begin()));
}

}  // namespace

void ApplyMotion(Application& a) {
  if (a.command.verb == Verb::kKeyframe) SolveKeyframe(a);
  if (a.command.verb == Verb::kFill) Fill(a);
  if (a.command.verb == Verb::kSmooth) Smooth(a);
  if (a.command.verb == Verb::kFrame) ShowFrame(a);
}

}  // namespace pregrasp::internal
