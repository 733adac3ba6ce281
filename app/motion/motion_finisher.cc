#include "app/motion/motion_finisher.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "app/core/check.h"
#include "app/hand/hand_kinematics.h"
#include "app/motion/touches.h"

namespace pregrasp {
namespace {

constexpr int kTimings = 6;                // how often free intervals are timed anew, at most
constexpr int kRoughIterations = 12;       // of smoothing, while they are
constexpr double kWorthShortening = 0.75;  // of the pace: what needs less is given less time
constexpr double kWorthGrowing =
    0.97;                           // longer times that bring down the share no more are no help
constexpr int kRepairs = 4;         // how often more room is asked for
constexpr double kMoreRoom = 5e-4;  // each time [m]
// Weights of staying near the pose that was filled in, as residuals: in contact that one is known
// to do, in free parts it is a corner of a way.
constexpr double kHold = 0.3, kHoldFree = 0.05;
// Of the limits, at first and by how much more each time: a motion with jumps in it is to become
// smooth before it is held to them, or it is torn out of its contacts.
constexpr double kFirstUrgency = 0.05, kMoreUrgent = 3.0;
constexpr double kMoreHold = 4.0;  // each time
constexpr int kHoldReach = 2;      // frames about one that fails
constexpr int kMaxSteps = 600;

}  // namespace

void MotionFinisher::Run() {
  for (std::size_t i = 0; i < state_.frames.size(); ++i) {
    // In contact, fingers are as near to each other and to the object as they must be.
    const bool touches = AnyOn(state_.task->frames[i].contacts);
    const double room = touches ? config_.ik.clearance_buffer : config_.smoothing_clearance;
    asked_.push_back({room, std::min(state_.frames[i].rung, LooseningRung::kClearance1mm),
                      state_.frames[i].configuration, touches ? kHold : kHoldFree});
  }
  last_share_.assign(state_.task->num_intervals(), std::numeric_limits<double>::infinity());
  double urgency = kFirstUrgency;
  for (int round = 0; round < kTimings; ++round) {
    SmoothOnce(kRoughIterations, urgency);
    const bool calm = urgency >= 1.0;
    urgency = std::min(1.0, kMoreUrgent * urgency);
    if (!Retime(round) && calm) break;
  }
  SmoothOnce(config_.smoothing.iterations, 1.0);
  for (int repair = 0; repair < kRepairs && !Check(); ++repair) {
    AskForMore();
    SmoothOnce(kRoughIterations, 1.0);
  }
  if (!Check()) Polish();
}

// Where a frame fails that had a pose when it was filled in, that one is to be kept to more, and
// where something is too near, there is to be more room.
void MotionFinisher::AskForMore() {
  const int count = static_cast<int>(state_.frames.size());
  std::vector<bool> fails(count, false);
  for (int i = 0; i < count; ++i) {
    const MotionFrame& frame = state_.frames[i];
    fails[i] = frame.failed() || frame.rung > asked_[i].rung;
    if (frame.way_clear && frame.clearance >= config_.ik.min_clearance) continue;
    asked_[i].room += kMoreRoom;
    if (!frame.way_clear && i > 0) asked_[i - 1].room += kMoreRoom;
  }
  for (int i = 0; i < count; ++i) {
    const int begin = std::max(0, i - kHoldReach), end = std::min(count, i + kHoldReach + 1);
    if (std::find(fails.begin() + begin, fails.begin() + end, true) == fails.begin() + end)
      continue;
    if (!MakeIkProblem(state_.task->frames[i]).contacts.empty()) asked_[i].hold *= kMoreHold;
  }
}

// A frame that still fails is moved, by inverse kinematics of its own, to the nearest pose that
// does not, unless that costs the ways to it or from it.
void MotionFinisher::Polish() {
  const int count = static_cast<int>(state_.frames.size());
  for (int i = 1; i < count; ++i) {
    if (!state_.frames[i].failed() && state_.frames[i].rung <= asked_[i].rung) continue;
    const MotionFrame frame = state_.frames[i];
    const bool after_clear = i + 1 == count || state_.frames[i + 1].way_clear;
    IkProblem problem = MakeIkProblem(state_.task->frames[i]);
    problem.warm_start = problem.reference = frame.configuration;
    IkConfig ik = LoosenIk(config_.ik, asked_[i].rung);
    ik.max_starts = ik.warm_starts = 1;
    ik.reason_starts = 0;
    const IkResult result = solver_.Solve(ik, problem, Rng(0, RngStream::kMotionPolish, i));
    if (!result.solved()) continue;
    state_.frames[i].configuration = result.configuration();
    CheckFrame(i);
    CheckWayTo(i);
    if (i + 1 < count) CheckWayTo(i + 1);
    const bool breaks = (frame.way_clear && !state_.frames[i].way_clear) ||
                        (after_clear && i + 1 < count && !state_.frames[i + 1].way_clear);
    if (!breaks) continue;
    state_.frames[i] = frame;
    if (i + 1 < count) CheckWayTo(i + 1);
  }
}

HandDemand MotionFinisher::MakeDemand(const Asked& asked) const {
  HandDemand demand{LoosenIk(config_.ik, asked.rung), {}};
  demand.config.clearance_buffer = asked.room;
  demand.config.influence =
      std::max(demand.config.influence, demand.config.min_clearance + 2.0 * asked.room);
  return demand;
}

HandDemand MotionFinisher::DemandOf(int i) const {
  HandDemand demand = MakeDemand(asked_[i]);
  demand.problem = MakeIkProblem(state_.task->frames[i]);
  demand.problem.reference = asked_[i].anchor;
  demand.problem.reference_weight = asked_[i].hold * asked_[i].hold;
  return demand;
}

// Of the middle of the way to frame i: no overlap.
HandDemand MotionFinisher::DemandOfWayTo(int i) const {
  const MotionFrameTask &before = state_.task->frames[i - 1], &task = state_.task->frames[i];
  HandDemand demand = MakeDemand(
      {asked_[i].room, std::max(asked_[i - 1].rung, asked_[i].rung), HandConfiguration(), 0.0});
  demand.problem.X_WB = task.X_WB_way[task.X_WB_way.size() / 2];
  for (int f = 0; f < kNumFingers; ++f) {
    demand.problem.may_touch[f] = before.contacts[f].on || task.contacts[f].on;
  }
  demand.problem.reference = state_.frames[i].configuration;
  demand.problem.reference_weight = 0.0;
  return demand;
}

void MotionFinisher::SmoothOnce(int iterations, double urgency) {
  std::vector<HandDemand> demands, ways;
  const int count = static_cast<int>(state_.frames.size());
  for (int i = 0; i < count; ++i) {
    demands.push_back(DemandOf(i));
    if (i > 0) ways.push_back(DemandOfWayTo(i));
  }
  std::vector<HandConfiguration> motion = ConfigurationsOf(state_.frames);
  SmoothingConfig smoothing = config_.smoothing;
  smoothing.iterations = std::min(iterations, smoothing.iterations);
  smoothing.limit_weight *= urgency;
  const SmoothingResult result =
      SmoothMotion(solver_, demands, ways, config_.limits, state_.task->fps, smoothing, &motion);
  state_.iterations += result.iterations;
  for (int i = 0; i < count; ++i) state_.frames[i].configuration = motion[i];
}

// Gives free intervals more time where the hand is too fast in them, and less where it idles.
// False where nothing was to change.
bool MotionFinisher::Retime(int round) {
  const std::vector<HandConfiguration> motion = ConfigurationsOf(state_.frames);
  const MotionTask task = *state_.task;
  bool changed = false;
  for (int k = task.num_intervals() - 1; k >= 0; --k) {
    if (!task.is_free[k]) continue;
    HandRates rates;
    for (int i = task.keyframes[k]; i <= task.keyframes[k + 1]; ++i) {
      rates.Include(CalcRates(solver_.hand(), config_.limits, motion, i, task.fps));
    }
    // With the time, speeds fall by its inverse, accelerations by its inverse square.
    const double share = std::max(rates.speed_share, std::sqrt(rates.acceleration_share));
    const int steps = task.num_steps(k);
    int wanted = steps;
    if (share > 1.0 && share < kWorthGrowing * last_share_[k]) {
      wanted = static_cast<int>(std::ceil(steps * share / config_.pace));
      last_share_[k] = share;
    } else if (share < kWorthShortening * config_.pace && round + 2 < kTimings) {
      wanted = static_cast<int>(std::ceil(steps * std::max(0.5, share / config_.pace)));
    }
    wanted = std::min(wanted, kMaxSteps);
    if (wanted == steps) continue;
    Resample(k, wanted);
    changed = true;
  }
  return changed;
}

// The same way in another number of steps.
void MotionFinisher::Resample(int interval, int steps) {
  const int begin = state_.task->keyframes[interval];
  const int old_steps = state_.task->num_steps(interval);
  std::vector<MotionFrame> frames(state_.frames.begin(), state_.frames.begin() + begin + 1);
  std::vector<Asked> asked(asked_.begin(), asked_.begin() + begin + 1);
  for (int i = 1; i < steps; ++i) {
    const double at = static_cast<double>(i) * old_steps / steps;
    const int before = std::min(static_cast<int>(at), old_steps - 1);
    const MotionFrame &a = state_.frames[begin + before], &b = state_.frames[begin + before + 1];
    MotionFrame frame = at - before < 0.5 ? a : b;
    const HandVector step = CalcStep(a.configuration, b.configuration);
    frame.configuration = Advance(a.configuration, HandVector((at - before) * step));
    frame.rung = LooseningRung::kNone;
    frames.push_back(frame);
    const Asked &asked_a = asked_[begin + before], &asked_b = asked_[begin + before + 1];
    const HandVector way = CalcStep(asked_a.anchor, asked_b.anchor);
    asked.push_back({std::max(asked_a.room, asked_b.room), LooseningRung::kNone,
                     Advance(asked_a.anchor, HandVector((at - before) * way)),
                     at - before < 0.5 ? asked_a.hold : asked_b.hold});
  }
  frames.insert(frames.end(), state_.frames.begin() + begin + old_steps, state_.frames.end());
  asked.insert(asked.end(), asked_.begin() + begin + old_steps, asked_.end());
  state_.frames = std::move(frames);
  asked_ = std::move(asked);
  state_.task = std::make_shared<const MotionTask>(WithSteps(*state_.task, interval, steps));
}

// The strictest rung that the frame stands on.
void MotionFinisher::CheckFrame(int i) {
  MotionFrame& frame = state_.frames[i];
  const IkProblem problem = MakeIkProblem(state_.task->frames[i]);
  frame.rung = LooseningRung::kFailed;
  for (int r = 0; r < static_cast<int>(LooseningRung::kFailed); ++r) {
    const auto rung = static_cast<LooseningRung>(r);
    const IkResult result =
        solver_.Evaluate(LoosenIk(config_.ik, rung), problem, frame.configuration);
    frame.tip_error = result.tip_error;
    frame.clearance = result.clearance;
    if (!result.solved()) continue;
    frame.rung = rung;
    return;
  }
}

void MotionFinisher::CheckWayTo(int i) {
  MotionFrame& frame = state_.frames[i];
  const MotionFrame& before = state_.frames[i - 1];
  const LooseningRung rung =
      std::min(std::max(before.rung, frame.rung), LooseningRung::kClearance1mm);
  const IkConfig ik = LoosenIk(config_.ik, rung);
  HandWay way = MakeHandWay(state_.task->frames[i - 1], state_.task->frames[i],
                            before.configuration, frame.configuration);
  way.touch.depth = ik.contact_depth;
  way.min_clearance = ik.min_clearance;
  frame.way_clear = solver_.CheckWay(way).clear;
}

bool MotionFinisher::Check() {
  bool clean = true;
  for (int i = 0; i < static_cast<int>(state_.frames.size()); ++i) {
    CheckFrame(i);
    if (i > 0) CheckWayTo(i);
    clean = clean && !state_.frames[i].failed() && state_.frames[i].rung <= asked_[i].rung;
  }
  return clean;
}

}  // namespace pregrasp
