#include "app/motion/hand_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "app/core/check.h"
#include "app/core/ease.h"
#include "app/core/finite.h"
#include "app/core/interrupt.h"
#include "app/motion/motion_finisher.h"
#include "app/motion/touches.h"

namespace pregrasp {
namespace {

constexpr std::array kRungs = {LooseningRung::kNone,     LooseningRung::kTip5mm,
                               LooseningRung::kCone80,   LooseningRung::kConeOff,
                               LooseningRung::kDepth3mm, LooseningRung::kClearance1mm};

// The hand carried along rigidly with the object from one pose to another.
HandConfiguration Carry(const HandConfiguration& hand, const RigidTransform& X_WO_from,
                        const RigidTransform& X_WO_to) {
  HandConfiguration carried = hand;
  carried.X_WH = X_WO_to * X_WO_from.inverse() * hand.X_WH;
  return carried;
}

void RecordResult(const IkResult& result, LooseningRung rung, MotionFrame* frame) {
  PREGRASP_CHECK(AreFinite(result.X_WH, result.q, result.tip_error, result.clearance),
                 result.tip_error, result.clearance);
  frame->configuration = result.configuration();
  frame->solved = true;
  frame->rung = rung;
  frame->tip_error = result.tip_error;
  frame->clearance = result.clearance;
  if (result.method != IkMethod::kNone) frame->method = result.method;
}

// The task of a frame, and for fingers that are off in it and on in the frame before or after:
// their contacts there, a little off.
MotionFrameTask WithNextContacts(const MotionTask& task, int frame) {
  constexpr double kOff = 4e-3;  // [m]
  MotionFrameTask wider = task.frames[frame];
  const int last = static_cast<int>(task.frames.size()) - 1;
  for (const int other : {std::min(frame + 1, last), std::max(frame - 1, 0)}) {
    const bool comes_from_free = task.frames[std::max(frame, other)].X_WB_way.size() < 2;
    if (comes_from_free) continue;  // there is time to get there
    for (int f = 0; f < kNumFingers; ++f) {
      Placement::Contact contact = task.frames[other].contacts[f];
      if (wider.contacts[f].on || !contact.on) continue;
      contact.p_OC += kOff * contact.nhat_O;
      wider.contacts[f] = contact;
    }
  }
  return wider;
}

// How long a step from rest to rest takes within the limits, eased (Ease: at most 1.5 of the mean
// speed, and 6 of the mean over the time).
double CalcSeconds(const HandModel& hand, const HandLimits& limits, const HandVector& step) {
  const auto time = [](double way, double speed, double acceleration) {
    return std::max(1.5 * way / speed, std::sqrt(6.0 * way / acceleration));
  };
  double seconds = std::max(
      time(step.head<3>().norm(), limits.wrist_speed, limits.wrist_acceleration),
      time(step.segment<3>(3).norm(), limits.wrist_turn_speed, limits.wrist_turn_acceleration));
  for (int j = 0; j < hand.num_joints; ++j) {
    seconds = std::max(
        seconds, time(std::abs(step[6 + j]), hand.joints[j].max_speed, limits.joint_acceleration));
  }
  return seconds;
}

}  // namespace

const char* KeyframeOrderName(KeyframeOrder order) {
  return order == KeyframeOrder::kReverse ? "reverse" : "forward";
}

const char* LooseningRungName(LooseningRung rung) {
  constexpr std::array<const char*, kNumLooseningRungs> kNames{
      "none",           "tip 5 mm",          "cone 80 deg", "no cone",
      "tip depth 3 mm", "hand overlap 1 mm", "failed"};
  return kNames[static_cast<int>(rung)];
}

bool MotionState::is_hopeless() const {
  const auto has_failed = [this](int key) { return keys[key].failed(); };
  return std::any_of(solved_keys.begin(), solved_keys.end(), has_failed) ||
         std::find(detours.begin(), detours.end(), DetourKind::kBlocked) != detours.end();
}

std::vector<HandConfiguration> ConfigurationsOf(const std::vector<MotionFrame>& frames) {
  std::vector<HandConfiguration> motion;
  for (const MotionFrame& frame : frames) motion.push_back(frame.configuration);
  return motion;
}

IkConfig LoosenIk(IkConfig config, LooseningRung rung) {
  if (rung >= LooseningRung::kTip5mm) config.tip_tolerance = 5e-3;
  if (rung >= LooseningRung::kCone80) config.max_cone_deg = 80.0;
  if (rung >= LooseningRung::kConeOff) config.max_cone_deg = 180.0;
  if (rung >= LooseningRung::kDepth3mm) config.contact_depth = 3e-3;
  if (rung >= LooseningRung::kClearance1mm) config.min_clearance = -1e-3;
  return config;
}

HandMotion::HandMotion(const IkSolver& solver, MotionTask task, const HandConfiguration& grasp,
                       const MotionConfig& config, std::uint64_t seed)
    : solver_(solver),
      task_(std::make_shared<const MotionTask>(std::move(task))),
      grasp_(grasp),
      config_(config),
      seed_(seed) {
  config.ik.Validate();
  PREGRASP_CHECK(config.approach_distance >= 0.0, config.approach_distance);
  PREGRASP_CHECK(config.keyframe_starts >= 1 && config.frame_starts >= 1, config.keyframe_starts,
                 config.frame_starts);
  PREGRASP_CHECK(task_->keyframes.size() >= 3, task_->keyframes.size());
  PREGRASP_CHECK(task_->keyframes.front() == 0);
  PREGRASP_CHECK(task_->keyframes.back() + 1 == static_cast<int>(task_->frames.size()));
  PREGRASP_CHECK(task_->is_free.size() + 1 == task_->keyframes.size(), task_->is_free.size());
}

MotionState HandMotion::Start() const {
  MotionState state;
  state.task = task_;
  state.keys.resize(task_->keyframes.size());
  return state;
}

// Within at most `starts` starts on each rung of the ladder. `rng` of the frame.
MotionFrame HandMotion::SolveFrame(const MotionFrameTask& task, const HandConfiguration& warm_start,
                                   const HandConfiguration& reference, int starts,
                                   const Rng& rng) const {
  IkProblem problem = MakeIkProblem(task);
  problem.warm_start = warm_start;
  problem.reference = reference;
  MotionFrame solved;
  for (const LooseningRung rung : kRungs) {
    IkConfig ik = LoosenIk(config_.ik, rung);
    ik.max_starts = starts;
    ik.warm_starts = starts;
    ik.reason_starts = 0;
    const IkResult result =
        solver_.Solve(ik, problem, rng.Split(RngStream::kMotionFrame, static_cast<int>(rung)));
    RecordResult(result, rung, &solved);
    if (result.solved()) return solved;
  }
  solved.rung = LooseningRung::kFailed;
  return solved;
}

DetourProblem HandMotion::MakeDetour(const MotionFrameTask& begin, const MotionFrameTask& end,
                                     const HandConfiguration& from,
                                     const HandConfiguration& to) const {
  DetourProblem problem;
  problem.from = from;
  problem.to = to;
  problem.X_WB = end.X_WB;
  problem.from_contacts = MakeIkProblem(begin).contacts;
  problem.to_contacts = MakeIkProblem(end).contacts;
  problem.up_W = task_->up_W;
  return problem;
}

// From `approach_distance` off, along the first direction in which the straight way to the first
// contact is free: back out along the forearm, out from the palm's back, or up, and their mixtures;
// if there is none, along the clearest.
MotionFrame HandMotion::SolveApproachStart(const HandConfiguration& first_contact) const {
  const Matrix3& R_WH = first_contact.X_WH.linear();
  const Vector3 back = -R_WH.col(2), dorsal = R_WH.col(1), up = task_->up_W;
  const std::array<Vector3, 6> directions = {up + back,     up,    up + dorsal, back,
                                             back + dorsal, dorsal};
  const MotionFrameTask& task = task_->frames.front();
  const MotionFrameTask& contact = task_->frames[task_->keyframes[1]];
  const IkProblem problem = MakeIkProblem(task);
  DetourConfig straight = config_.detour;
  straight.max_tries = 0;
  const auto stream = [&](std::size_t i) { return Rng(seed_, RngStream::kMotionApproach, 0, i); };
  std::optional<MotionFrame> best;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    HandConfiguration open = first_contact;
    open.q = solver_.hand().posture;
    open.X_WH.translation() += config_.approach_distance * directions[i].normalized();
    const Rng rng = stream(i);
    const MotionFrame start = SolveFrame(task, open, open, config_.frame_starts, rng);
    if (start.failed()) continue;
    const DetourResult way =
        FindDetour(solver_, config_.ik, straight,
                   MakeDetour(task, contact, start.configuration, first_contact), rng);
    if (way.kind != DetourKind::kBlocked) return start;
    if (!best || start.clearance > best->clearance + 1e-3) best = start;
  }
  if (best) return *best;
  HandConfiguration open = first_contact;
  open.X_WH.translation() += config_.approach_distance * up;
  return SolveFrame(task, open, open, config_.keyframe_starts, stream(directions.size()));
}

std::vector<int> HandMotion::KeyframeSequence() const {
  std::vector<int> sequence(task_->keyframes.size());
  std::iota(sequence.begin(), sequence.end(), 0);
  if (config_.order == KeyframeOrder::kReverse) {
    std::reverse(sequence.begin(), sequence.end());
    // One without contacts goes where the contacts before it have left the hand, if there are any:
    // after these. The start of the approach comes last.
    const auto touches = [this](int key) {
      return AnyOn(task_->frames[task_->keyframes[key]].contacts);
    };
    for (std::size_t i = sequence.size() - 1; i-- > 0;) {
      if (touches(sequence[i])) continue;
      std::size_t last = i + 1;
      while (last < sequence.size() && !touches(sequence[last])) ++last;
      if (last == sequence.size()) continue;
      std::reverse(sequence.begin() + i, sequence.begin() + last);
      std::rotate(sequence.begin() + i, sequence.begin() + last, sequence.begin() + last + 1);
    }
  }
  if (config_.order == KeyframeOrder::kForward) {
    // The approach leads to the first contact, so it can only be laid out once that is known.
    std::rotate(sequence.begin(), sequence.begin() + 1, sequence.end());
  }
  return sequence;
}

bool HandMotion::SolveKeyframe(MotionState& state) const {
  const std::vector<int> sequence = KeyframeSequence();
  if (state.solved_keys.size() == sequence.size()) return false;
  const int key = sequence[state.solved_keys.size()];
  const MotionFrameTask& task = task_->frames[task_->keyframes[key]];
  if (key == 0) {
    state.keys[0] = SolveApproachStart(state.keys[1].configuration);
  } else {
    // The first one solved starts from the grasp, each other one from the one before it, carried
    // along with the object.
    const RigidTransform& X_WO = task.X_WB.front();
    HandConfiguration guess;
    if (state.solved_keys.empty()) {
      const auto closed =
          std::find_if(task_->frames.rbegin(), task_->frames.rend(),
                       [](const auto& frame) { return frame.phase == MotionPhase::kClosing; });
      PREGRASP_CHECK(closed != task_->frames.rend());
      guess = Carry(grasp_, closed->X_WB.front(), X_WO);
    } else {
      const int from = state.solved_keys.back();
      guess = Carry(state.keys[from].configuration,
                    task_->frames[task_->keyframes[from]].X_WB.front(), X_WO);
    }
    const Rng rng(seed_, RngStream::kMotionKey, 0, key);
    const MotionFrameTask wider = WithNextContacts(*task_, task_->keyframes[key]);
    MotionFrame both = SolveFrame(wider, guess, guess, config_.keyframe_starts, rng);
    // Where a finger has just left or is about to come, a pose that does for both is sought.
    const bool does =
        !both.failed() && both.rung == LooseningRung::kNone &&
        solver_.Evaluate(config_.ik, MakeIkProblem(task), both.configuration).solved();
    state.keys[key] = does ? both : SolveFrame(task, guess, guess, config_.keyframe_starts, rng);
  }
  state.solved_keys.push_back(key);
  return true;
}

// Whether nothing happens in an interval but the hand's way: the bodies stand, and fingers that are
// on in between stay where they are at both ends.
bool HandMotion::IsIdle(const MotionTask& task, int interval) const {
  constexpr double kStands = 2e-4;  // [m], and of a point 10 cm off as it turns
  const int begin = task.keyframes[interval], end = task.keyframes[interval + 1];
  for (int frame = begin + 1; frame <= end; ++frame) {
    for (int f = 0; f < kNumFingers && frame < end; ++f) {
      const Placement::Contact& contact = task.frames[frame].contacts[f];
      if (!contact.on) continue;
      for (const int key : {begin, end}) {
        const Placement::Contact& at_key = task.frames[key].contacts[f];
        if (!at_key.on || !((at_key.p_OC - contact.p_OC).norm() <= kStands)) return false;
      }
    }
    for (std::size_t b = 0; b < task.frames[frame].X_WB.size(); ++b) {
      const RigidTransform &X = task.frames[frame].X_WB[b], &X_end = task.frames[end].X_WB[b];
      const double moved = (X.translation() - X_end.translation()).norm() +
                           0.1 * RotationAngle(X.linear(), X_end.linear());
      if (!(moved <= kStands)) return false;
    }
  }
  return true;
}

// Fills an interval in which the bodies stand along a way without collision. A free one gets the
// time that it takes from rest to rest. False, with nothing filled in, if there is no way and the
// time is given.
bool HandMotion::FillAlongWay(MotionState& state, int interval) const {
  const MotionTask& task = *state.task;
  const MotionFrame &begin = state.keys[interval], &end = state.keys[interval + 1];
  const DetourResult way = FindDetour(
      solver_, config_.ik, config_.detour,
      MakeDetour(task.frames[task.keyframes[interval]], task.frames[task.keyframes[interval + 1]],
                 begin.configuration, end.configuration),
      Rng(seed_, RngStream::kMotionDetour, 0, interval));
  if (way.kind == DetourKind::kBlocked && !task.is_free[interval]) return false;
  state.detours.insert(state.detours.begin(), way.kind);
  std::vector<double> times{0.0};
  for (std::size_t i = 1; i < way.points.size(); ++i) {
    const HandVector step = CalcStep(way.points[i - 1], way.points[i]);
    times.push_back(times.back() + CalcSeconds(solver_.hand(), config_.limits, step));
  }
  int steps = task.num_steps(interval);
  if (task.is_free[interval]) {
    steps = std::max(1, static_cast<int>(std::ceil(times.back() * task.fps)));
    state.task = std::make_shared<const MotionTask>(WithSteps(task, interval, steps));
  }
  std::vector<MotionFrame> between;
  std::size_t leg = 1;
  for (int i = 1; i < steps; ++i) {
    const double t = times.back() * i / steps;
    while (leg + 1 < times.size() && times[leg] < t) ++leg;
    MotionFrame frame = end;
    frame.rung = LooseningRung::kNone;
    frame.method = IkMethod::kNone;
    if (times.back() > 0.0) {
      const double s = (t - times[leg - 1]) / (times[leg] - times[leg - 1]);
      frame.configuration = Interpolate(way.points[leg - 1], way.points[leg], Ease(s));
    }
    between.push_back(frame);
  }
  state.frames.insert(state.frames.begin(), between.begin(), between.end());
  return true;
}

// In-betweens at the speed of the physics, last first. In the object's frame, so that a hand in
// contact moves with the object, each goes on from the one after it by an even share of what is
// left to the keyframe before: where the way between the keyframes had to be left, it is not jumped
// back to.
void HandMotion::FillTimed(MotionState& state, int interval) const {
  const MotionTask& task = *state.task;
  const int begin = task.keyframes[interval], end = task.keyframes[interval + 1];
  const RigidTransform& X_WO_begin = task.frames[begin].X_WB.front();
  for (int frame = end - 1; frame > begin; --frame) {
    const RigidTransform& X_WO = task.frames[frame].X_WB.front();
    const HandConfiguration goal = Carry(state.keys[interval].configuration, X_WO_begin, X_WO);
    const HandConfiguration after =
        Carry(state.frames.front().configuration, task.frames[frame + 1].X_WB.front(), X_WO);
    const HandConfiguration next = Interpolate(after, goal, 1.0 / (frame + 1 - begin));
    const Rng rng(seed_, RngStream::kMotionIk, interval, frame - begin);
    MotionFrame solved = SolveStrictly(task.frames[frame], next, next, rng);
    if (solved.failed()) solved = SolveStrictly(task.frames[frame], after, next, rng);
    if (solved.failed()) {
      solved = SolveFrame(task.frames[frame], after, next, config_.frame_starts, rng);
    }
    state.frames.insert(state.frames.begin(), solved);
  }
}

MotionFrame HandMotion::SolveStrictly(const MotionFrameTask& task,
                                      const HandConfiguration& warm_start,
                                      const HandConfiguration& reference, const Rng& rng) const {
  IkProblem problem = MakeIkProblem(task);
  problem.warm_start = warm_start;
  problem.reference = reference;
  IkConfig ik = config_.ik;
  ik.max_starts = ik.warm_starts = 1;
  ik.reason_starts = 0;
  const IkResult result = solver_.Solve(ik, problem, rng);
  MotionFrame solved;
  RecordResult(result, result.solved() ? LooseningRung::kNone : LooseningRung::kFailed, &solved);
  return solved;
}

void HandMotion::FillInBetweens(MotionState& state) const {
  PREGRASP_CHECK(state.solved_keys.size() == task_->keyframes.size());
  state.frames = {state.keys.back()};
  for (int interval = task_->num_intervals() - 1; interval >= 0; --interval) {
    ThrowIfInterrupted();
    const bool stands = task_->is_free[interval] || IsIdle(*task_, interval);
    if (!stands || !FillAlongWay(state, interval)) FillTimed(state, interval);
    state.frames.insert(state.frames.begin(), state.keys[interval]);
  }
  PREGRASP_CHECK(state.frames.size() == state.task->frames.size(), state.frames.size());
  state.filled = true;
}

void HandMotion::Smooth(MotionState& state) const {
  PREGRASP_CHECK(state.filled && !state.finished);
  MotionFinisher(solver_, config_, state).Run();
  state.finished = true;
}

void HandMotion::Finish(MotionState& state) const {
  while (SolveKeyframe(state)) {
  }
  if (!state.filled) FillInBetweens(state);
  if (!state.finished) Smooth(state);
}

bool IsForearmFree(const Forearm& forearm, const MotionState& state) {
  for (std::size_t i = 0; i < state.frames.size(); ++i) {
    const RigidTransform& X_WH = state.frames[i].configuration.X_WH;
    if (!forearm.IsFree(state.task->frames[i].X_WB, X_WH)) return false;
  }
  return true;
}

MotionSummary HandMotion::Summarize(const MotionState& state) const {
  MotionSummary summary;
  summary.frames = static_cast<int>(state.frames.size());
  summary.min_clearance = std::numeric_limits<double>::infinity();
  const std::vector<HandConfiguration> motion = ConfigurationsOf(state.frames);
  for (int i = 0; i < summary.frames; ++i) {
    const MotionFrame& frame = state.frames[i];
    summary.failed += frame.failed();
    summary.blocked_ways += !frame.way_clear;
    summary.loosened += !frame.failed() && frame.rung != LooseningRung::kNone;
    summary.max_tip_error = std::max(summary.max_tip_error, frame.tip_error);
    summary.min_clearance = std::min(summary.min_clearance, frame.clearance);
    const HandRates rates = CalcRates(solver_.hand(), config_.limits, motion, i, state.task->fps);
    summary.rates.Include(rates);
    summary.phase_rates[static_cast<int>(state.task->frames[i].phase)].Include(rates);
    summary.over_limits += !rates.IsWithinLimits();
  }
  PREGRASP_CHECK(AreFinite(summary.max_tip_error, summary.min_clearance, summary.rates.speed_share,
                           summary.rates.acceleration_share),
                 summary.frames, summary.min_clearance, summary.rates.speed_share);
  return summary;
}

}  // namespace pregrasp
