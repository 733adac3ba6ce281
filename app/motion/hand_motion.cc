#include "app/motion/hand_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "app/core/check.h"
#include "app/core/ease.h"
#include "app/core/finite.h"

namespace pregrasp {
namespace {

constexpr std::array kRungs = {LooseningRung::kNone,     LooseningRung::kTip5mm,
                               LooseningRung::kCone80,   LooseningRung::kConeOff,
                               LooseningRung::kDepth3mm, LooseningRung::kClearance1mm};

IkConfig Loosen(IkConfig config, LooseningRung rung) {
  if (rung >= LooseningRung::kTip5mm) config.tip_tolerance = 5e-3;
  if (rung >= LooseningRung::kCone80) config.max_cone_deg = 80.0;
  if (rung >= LooseningRung::kConeOff) config.max_cone_deg = 180.0;
  if (rung >= LooseningRung::kDepth3mm) config.contact_depth = 3e-3;
  if (rung >= LooseningRung::kClearance1mm) config.min_clearance = -1e-3;
  return config;
}

HandConfiguration Interpolate(const HandConfiguration& a, const HandConfiguration& b, double s) {
  return Advance(a, HandVector(s * CalcStep(a, b)));
}

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
  frame->method = result.method;
}

}  // namespace

const char* KeyframeOrderName(KeyframeOrder order) {
  return order == KeyframeOrder::kReverse ? "reverse" : "forward";
}

const char* LooseningRungName(LooseningRung rung) {
  switch (rung) {
    case LooseningRung::kNone:
      return "none";
    case LooseningRung::kTip5mm:
      return "tip 5 mm";
    case LooseningRung::kCone80:
      return "cone 80 deg";
    case LooseningRung::kConeOff:
      return "no cone";
    case LooseningRung::kDepth3mm:
      return "tip depth 3 mm";
    case LooseningRung::kClearance1mm:
      return "hand overlap 1 mm";
    case LooseningRung::kFailed:
      return "failed";
  }
  return "";
}

HandMotion::HandMotion(const IkSolver& solver, MotionTask task, const HandConfiguration& grasp,
                       const MotionConfig& config, std::uint64_t seed)
    : solver_(solver), task_(std::move(task)), grasp_(grasp), config_(config), seed_(seed) {
  config.ik.Validate();
  PREGRASP_CHECK(config.approach_distance >= 0.0, config.approach_distance);
  PREGRASP_CHECK(config.keyframe_starts >= 1 && config.frame_starts >= 1, config.keyframe_starts,
                 config.frame_starts);
  PREGRASP_CHECK(task_.keyframes.size() >= 3, task_.keyframes.size());
  PREGRASP_CHECK(task_.keyframes.front() == 0);
  PREGRASP_CHECK(task_.keyframes.back() + 1 == static_cast<int>(task_.frames.size()));
}

MotionState HandMotion::Start() const {
  MotionState state;
  state.frames.resize(task_.frames.size());
  return state;
}

MotionFrame HandMotion::SolveFrame(int frame, const HandConfiguration& warm_start,
                                   const HandConfiguration& reference, int starts) const {
  IkProblem problem = MakeIkProblem(task_.frames[frame]);
  problem.warm_start = warm_start;
  problem.reference = reference;
  MotionFrame solved;
  for (const LooseningRung rung : kRungs) {
    IkConfig ik = Loosen(config_.ik, rung);
    ik.max_starts = starts;
    ik.warm_starts = starts;
    const Rng rng(seed_, RngStream::kMotionIk, frame, static_cast<int>(rung));
    const IkResult result = solver_.Solve(ik, problem, rng);
    RecordResult(result, rung, &solved);
    if (result.solved()) return solved;
  }
  solved.rung = LooseningRung::kFailed;
  return solved;
}

// From `approach_distance` off, along the direction in which the straight way to the first contact
// is clearest: back out along the forearm, out from the palm's back, or up, and their mixtures.
MotionFrame HandMotion::SolveApproachStart(const HandConfiguration& first_contact) const {
  const Matrix3& R_WH = first_contact.X_WH.linear();
  const Vector3 back = -R_WH.col(2), dorsal = R_WH.col(1), up = Vector3::UnitZ();
  const std::array<Vector3, 6> directions = {up + back,     up,    up + dorsal, back,
                                             back + dorsal, dorsal};
  HandConfiguration best = first_contact;
  double best_clearance = -std::numeric_limits<double>::infinity();
  const IkProblem problem = MakeIkProblem(task_.frames.front());
  for (const Vector3& direction : directions) {
    HandConfiguration open = first_contact;
    open.q = RelaxedPosture();
    double clearance = std::numeric_limits<double>::infinity();
    for (const double share : {0.25, 0.5, 0.75, 1.0}) {
      open.X_WH.translation() = first_contact.X_WH.translation() +
                                share * config_.approach_distance * direction.normalized();
      clearance = std::min(clearance, solver_.Evaluate(config_.ik, problem, open).clearance);
    }
    if (clearance > best_clearance + 1e-3) {
      best_clearance = clearance;
      best = open;
    }
  }
  return SolveFrame(0, best, best, config_.keyframe_starts);
}

std::vector<int> HandMotion::KeyframeSequence() const {
  std::vector<int> sequence = task_.keyframes;
  if (config_.order == KeyframeOrder::kReverse) std::reverse(sequence.begin(), sequence.end());
  if (config_.order == KeyframeOrder::kForward) {
    // The approach leads to the first contact, so it can only be laid out once that is known.
    std::rotate(sequence.begin(), sequence.begin() + 1, sequence.end());
  }
  return sequence;
}

bool HandMotion::SolveKeyframe(MotionState& state) const {
  const std::vector<int> sequence = KeyframeSequence();
  if (state.solved_keys.size() == sequence.size()) return false;
  const int frame = sequence[state.solved_keys.size()];
  if (frame == 0) {
    state.frames[0] = SolveApproachStart(state.frames[task_.keyframes[1]].configuration);
  } else {
    // The first one solved starts from the grasp, each other one from the one before it, carried
    // along with the object.
    const bool first = state.solved_keys.empty();
    const int from = first ? static_cast<int>(task_.frames.size()) - 1 : state.solved_keys.back();
    const RigidTransform& X_WO = task_.frames[frame].X_WB.front();
    const RigidTransform X_WO_grasp = [&] {
      for (auto it = task_.frames.rbegin(); it != task_.frames.rend(); ++it) {
        if (it->phase == MotionPhase::kClosing) return it->X_WB.front();
      }
      return task_.frames.back().X_WB.front();
    }();
    const HandConfiguration guess =
        first ? Carry(grasp_, X_WO_grasp, X_WO)
              : Carry(state.frames[from].configuration, task_.frames[from].X_WB.front(), X_WO);
    state.frames[frame] = SolveFrame(frame, guess, guess, config_.keyframe_starts);
  }
  state.solved_keys.push_back(frame);
  return true;
}

void HandMotion::FillInBetweens(MotionState& state) const {
  PREGRASP_CHECK(state.solved_keys.size() == task_.keyframes.size());
  for (std::size_t k = 0; k + 1 < task_.keyframes.size(); ++k) {
    const int begin = task_.keyframes[k], end = task_.keyframes[k + 1];
    // Interpolated in the object's frame, so that a hand in contact moves with the object.
    const RigidTransform& X_WO_begin = task_.frames[begin].X_WB.front();
    const RigidTransform& X_WO_end = task_.frames[end].X_WB.front();
    for (int frame = end - 1; frame > begin; --frame) {
      const RigidTransform& X_WO = task_.frames[frame].X_WB.front();
      const HandConfiguration a = Carry(state.frames[begin].configuration, X_WO_begin, X_WO);
      const HandConfiguration b = Carry(state.frames[end].configuration, X_WO_end, X_WO);
      const double s = static_cast<double>(frame - begin) / (end - begin);
      const HandConfiguration between = Interpolate(a, b, Ease(s));
      state.frames[frame] = SolveFrame(frame, between, between, config_.frame_starts);
    }
  }
  state.filled = true;
}

void HandMotion::Smooth(MotionState& state) const {
  PREGRASP_CHECK(state.filled);
  const int count = static_cast<int>(task_.frames.size());
  for (int frame = 1; frame + 1 < count; ++frame) {
    MotionFrame& current = state.frames[frame];
    const HandConfiguration mean = Interpolate(state.frames[frame - 1].configuration,
                                               state.frames[frame + 1].configuration, 0.5);
    const MotionFrame moved = SolveFrame(frame, mean, mean, 1);
    // Only a frame that gives up no more than it did may move.
    if (moved.rung <= current.rung) current = moved;
  }
  ++state.sweeps;
}

void HandMotion::Finish(MotionState& state) const {
  while (SolveKeyframe(state)) {
  }
  if (!state.filled) FillInBetweens(state);
  while (state.sweeps < config_.smoothing_sweeps) Smooth(state);
}

MotionSummary HandMotion::Summarize(const MotionState& state) const {
  MotionSummary summary;
  summary.frames = static_cast<int>(state.frames.size());
  summary.min_clearance = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < state.frames.size(); ++i) {
    const MotionFrame& frame = state.frames[i];
    const bool solved = frame.solved && frame.rung != LooseningRung::kFailed;
    summary.failed += !solved;
    summary.loosened += solved && frame.rung != LooseningRung::kNone;
    summary.max_tip_error = std::max(summary.max_tip_error, frame.tip_error);
    summary.min_clearance = std::min(summary.min_clearance, frame.clearance);
    if (i == 0) continue;
    const double dt = task_.frames[i].t - task_.frames[i - 1].t;
    PREGRASP_CHECK(dt > 0.0, i, dt);
    const HandConfiguration& a = state.frames[i - 1].configuration;
    const HandConfiguration& b = frame.configuration;
    summary.max_joint_speed =
        std::max(summary.max_joint_speed, (b.q - a.q).cwiseAbs().maxCoeff() / dt);
    summary.max_wrist_speed = std::max(summary.max_wrist_speed,
                                       (b.X_WH.translation() - a.X_WH.translation()).norm() / dt);
  }
  PREGRASP_CHECK(AreFinite(summary.max_tip_error, summary.min_clearance, summary.max_joint_speed,
                           summary.max_wrist_speed),
                 summary.frames, summary.min_clearance, summary.max_joint_speed);
  return summary;
}

}  // namespace pregrasp
