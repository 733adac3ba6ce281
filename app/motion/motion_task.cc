#include "app/motion/motion_task.h"

#include <algorithm>
#include <cmath>

#include "app/core/check.h"
#include "app/core/finite.h"

namespace pregrasp {
namespace {

std::array<Placement::Contact, kNumFingers> ContactsOf(const WorldState& state) {
  std::array<Placement::Contact, kNumFingers> contacts{};
  for (int j = 0; j < kNumPlanningFingers; ++j) {
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

// Slow at both ends, so that the object starts and stops without a jerk.
double Ease(double s) { return s * s * (3.0 - 2.0 * s); }

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
                           const MotionGrasp& grasp, const Vector3& lift_W,
                           const MotionTiming& timing) {
  PREGRASP_CHECK(!trace.empty());
  PREGRASP_CHECK(timing.fps > 0.0, timing.fps);
  PREGRASP_CHECK(AreFinite(lift_W, timing.lift_height), timing.lift_height);
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

  const double seconds = trace.back().state.t - trace.front().state.t;
  const int count = FramesIn(seconds, timing.fps);
  const double rows_per_frame = static_cast<double>(trace.size() - 1) / count;
  for (int i = 0; i <= count; ++i) {
    const TraceRow& row = trace[static_cast<std::size_t>(std::lround(i * rows_per_frame))];
    const auto contacts = ContactsOf(row.state);
    const bool changes = !SameFingers(contacts, task.frames.back().contacts);
    add(MotionPhase::kContact, world.GetPoses(row.state), contacts);
    if (i == 0 || i == count || changes) mark_key();
  }

  const std::vector<RigidTransform> X_WB_end = task.frames.back().X_WB;
  const auto pressing = task.frames.back().contacts;
  const int closing = FramesIn(timing.closing_seconds, timing.fps);
  for (int i = 1; i <= closing; ++i) {
    // A pressing finger keeps its contact while the others close, if the grasp uses it there.
    std::array<Placement::Contact, kNumFingers> contacts{};
    for (int j = 0; j < kNumFingers; ++j) {
      const bool stays = pressing[j].on && grasp.contacts[j].on &&
                         (pressing[j].p_OC - grasp.contacts[j].p_OC).norm() < 1e-3;
      if (stays) contacts[j] = grasp.contacts[j];
    }
    add(MotionPhase::kClosing, X_WB_end, i == closing ? grasp.contacts : contacts);
    if (i == closing) mark_key();
  }

  const int lift = FramesIn(timing.lift_seconds, timing.fps);
  for (int i = 1; i <= lift; ++i) {
    std::vector<RigidTransform> X_WB = X_WB_end;
    const double height = timing.lift_height * Ease(static_cast<double>(i) / lift);
    X_WB[0].translation() += height * lift_W;
    add(MotionPhase::kLift, X_WB, grasp.contacts);
    if (i == lift) mark_key();
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
