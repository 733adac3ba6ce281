#include "app/motion/motion_task.h"

#include <algorithm>
#include <cmath>

#include "app/core/check.h"
#include "app/core/finite.h"

namespace pregrasp {
namespace {

std::array<Placement::Contact, kNumFingers> ContactsOf(const WorldState& state) {
  std::array<Placement::Contact, kNumFingers> contacts{};
  for (int j = 0; j < kNumFingers; ++j) {
    const FingertipState& tip = state.fingers[j];
    contacts[j] = {tip.on, tip.p_OC, tip.nhat_O};
  }
  return contacts;
}

bool SameFingers(const std::array<Placement::Contact, kNumFingers>& a,
                 const std::array<Placement::Contact, kNumFingers>& b) {
  for (int j = 0; j < kNumFingers; ++j) {
    if (a[j].on != b[j].on) return false;
  }
  return true;
}

int FramesIn(double seconds, double fps) {
  constexpr double kMaxFrames = 1e6;
  PREGRASP_CHECK(seconds >= 0.0 && seconds * fps <= kMaxFrames, seconds, fps);
  return std::max(1, static_cast<int>(std::lround(seconds * fps)));
}

// The row nearest to time t.
const TraceRow& RowAt(const std::vector<TraceRow>& trace, double t) {
  const auto later =
      std::lower_bound(trace.begin(), trace.end(), t,
                       [](const TraceRow& row, double seconds) { return row.state.t < seconds; });
  if (later == trace.begin()) return trace.front();
  if (later == trace.end()) return trace.back();
  const auto earlier = later - 1;
  return t - earlier->state.t < later->state.t - t ? *earlier : *later;
}

}  // namespace

const char* MotionPhaseName(MotionPhase phase) {
  switch (phase) {
    case MotionPhase::kApproach:
      return "approach";
    case MotionPhase::kContact:
      return "contact";
    case MotionPhase::kClosing:
      return "closing";
    case MotionPhase::kLift:
      return "lift";
  }
  return "";
}

MotionTask BuildMotionTask(const World& world, const std::vector<TraceRow>& trace,
                           const MotionLift& lift, const MotionTiming& timing) {
  PREGRASP_CHECK(!trace.empty() && !lift.trace.empty());
  PREGRASP_CHECK(timing.fps > 0.0, timing.fps);
  MotionTask task;
  const auto add = [&](MotionPhase phase, const std::vector<RigidTransform>& X_WB,
                       const std::array<Placement::Contact, kNumFingers>& contacts) {
    const double t = static_cast<double>(task.frames.size()) / timing.fps;
    task.frames.push_back({t, phase, X_WB, contacts});
  };
  const auto mark_key = [&] {
    const int last = static_cast<int>(task.frames.size()) - 1;
    if (task.keyframes.empty() || task.keyframes.back() != last) task.keyframes.push_back(last);
  };

  const std::vector<RigidTransform> X_WB_start = world.GetPoses(trace.front().state);
  for (int i = 0; i < FramesIn(timing.approach_seconds, timing.fps); ++i) {
    add(MotionPhase::kApproach, X_WB_start, {});
    if (i == 0) mark_key();
  }

  const double begin = trace.front().state.t, seconds = trace.back().state.t - begin;
  const int count = FramesIn(seconds, timing.fps);
  for (int i = 0; i <= count; ++i) {
    const TraceRow& row = RowAt(trace, begin + seconds * i / count);
    const auto contacts = ContactsOf(row.state);
    const bool changes = !SameFingers(contacts, task.frames.back().contacts);
    add(MotionPhase::kContact, world.GetPoses(row.state), contacts);
    if (i == 0 || i == count || changes) mark_key();
  }

  const auto pressing = task.frames.back().contacts;
  const auto grasp = ContactsOf(RowAt(lift.trace, lift.lift_t).state);
  const double end = lift.trace.front().state.t, closing_seconds = lift.lift_t - end;
  const int closing = FramesIn(timing.closing_seconds, timing.fps);
  for (int i = 1; i <= closing; ++i) {
    // A pressing finger keeps its contact while the others close, if the grasp uses it there.
    std::array<Placement::Contact, kNumFingers> contacts{};
    for (int j = 0; j < kNumFingers; ++j) {
      const bool stays =
          pressing[j].on && grasp[j].on && (pressing[j].p_OC - grasp[j].p_OC).norm() < 1e-3;
      if (stays) contacts[j] = grasp[j];
    }
    const TraceRow& row = RowAt(lift.trace, end + closing_seconds * i / closing);
    add(MotionPhase::kClosing, world.GetPoses(row.state), i == closing ? grasp : contacts);
    if (i == closing) mark_key();
  }

  const double lift_seconds = lift.trace.back().state.t - lift.lift_t;
  const int lifting = FramesIn(lift_seconds, timing.fps);
  for (int i = 1; i <= lifting; ++i) {
    const TraceRow& row = RowAt(lift.trace, lift.lift_t + lift_seconds * i / lifting);
    add(MotionPhase::kLift, world.GetPoses(row.state), ContactsOf(row.state));
    if (i == lifting) mark_key();
  }
  for (const MotionFrameTask& frame : task.frames) {
    PREGRASP_CHECK(AreFinite(frame.t, frame.X_WB), frame.t);
  }
  return task;
}

IkProblem MakeIkProblem(const MotionFrameTask& frame) {
  IkProblem problem;
  problem.X_WB = frame.X_WB;
  const RigidTransform& X_WO = frame.X_WB.front();
  for (int j = 0; j < kNumFingers; ++j) {
    const Placement::Contact& contact = frame.contacts[j];
    if (!contact.on) continue;
    problem.contacts.push_back(
        {static_cast<Finger>(j), X_WO * contact.p_OC, Vector3(X_WO.linear() * contact.nhat_O)});
  }
  return problem;
}

}  // namespace pregrasp
