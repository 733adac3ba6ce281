#include "app/motion/motion_task.h"

#include <algorithm>
#include <cmath>

#include "app/core/check.h"
#include "app/core/finite.h"
#include "app/motion/detour.h"
#include "app/motion/touches.h"

namespace pregrasp {
namespace {

constexpr double kStill = 1e-4;    // a body that moves less than this stands [m]
constexpr double kStillDeg = 0.1;  // and turns less than this [degrees]
constexpr int kMaxPosesOfWay = 9;  // from one frame to the next

bool SameFingers(const Contacts& a, const Contacts& b) {
  for (int j = 0; j < kNumFingers; ++j) {
    if (a[j].on != b[j].on) return false;
    if (a[j].on && (a[j].p_OC - b[j].p_OC).norm() > 5.0 * kSameContact) return false;
  }
  return true;
}

// The contacts of `a` that `b` has too.
Contacts Shared(const Contacts& a, const Contacts& b) {
  Contacts shared{};
  for (int j = 0; j < kNumFingers; ++j) {
    if (a[j].on && b[j].on && (a[j].p_OC - b[j].p_OC).norm() < kSameContact) shared[j] = a[j];
  }
  return shared;
}

// A simulation, and the contacts at each row of it.
struct Simulation {
  const std::vector<TraceRow>& trace;
  std::vector<Contacts> contacts;

  double begin() const { return trace.front().state.t; }
  double end() const { return trace.back().state.t; }
};

// Rows of a simulation between two times.
class Rows {
 public:
  Rows(const Simulation& simulation, double begin, double end)
      : trace_(simulation.trace), contacts_(simulation.contacts) {
    first_ = IndexAt(begin);
    last_ = IndexAt(end);
  }

  int first() const { return first_; }
  int last() const { return last_; }
  double seconds() const { return trace_[last_].state.t - trace_[first_].state.t; }
  // Of `count` steps that the time is divided into, the row at the i-th.
  int AtStep(int i, int count) const {
    const double t = trace_[first_].state.t + seconds() * i / count;
    return std::clamp(IndexAt(t), first_, last_);
  }
  const WorldState& operator[](int row) const { return trace_[row].state; }
  const Contacts& ContactsAt(int row) const { return contacts_[row]; }

 private:
  // The row nearest to time t.
  int IndexAt(double t) const {
    const auto later =
        std::lower_bound(trace_.begin(), trace_.end(), t,
                         [](const TraceRow& row, double seconds) { return row.state.t < seconds; });
    const int index = static_cast<int>(later - trace_.begin());
    if (index == 0) return 0;
    if (later == trace_.end()) return index - 1;
    return t - trace_[index - 1].state.t < later->state.t - t ? index - 1 : index;
  }

  const std::vector<TraceRow>& trace_;
  const std::vector<Contacts>& contacts_;
  int first_ = 0, last_ = 0;
};

// From when on nothing moves to the simulation's end, and no finger changes [s].
double FindStill(const Simulation& simulation) {
  const WorldState& end = simulation.trace.back().state;
  double still = end.t;
  for (std::size_t row = simulation.trace.size(); row-- > 0;) {
    const WorldState& state = simulation.trace[row].state;
    for (std::size_t i = 0; i < end.bodies.size(); ++i) {
      const BodyState &a = state.bodies[i], &b = end.bodies[i];
      if (!((a.p_WB - b.p_WB).norm() <= kStill) ||
          !(RadToDeg(a.q_WB.angularDistance(b.q_WB)) <= kStillDeg)) {
        return still;
      }
    }
    if (!SameFingers(simulation.contacts[row], simulation.contacts.back())) return still;
    still = state.t;
  }
  return still;
}

class TaskBuilder {
 public:
  TaskBuilder(const World& world, double fps) : world_(world) {
    task_.fps = fps;
    task_.up_W = -world.scene().gravity.normalized();
  }

  void Add(MotionPhase phase, const WorldState& state, const Contacts& contacts) {
    MotionFrameTask frame;
    frame.t = static_cast<double>(task_.frames.size()) / task_.fps;
    frame.simulated_t = state.t;
    frame.phase = phase;
    frame.X_WB = world_.GetPoses(state);
    frame.contacts = contacts;
    if (!task_.frames.empty()) frame.X_WB_way = {frame.X_WB};
    task_.frames.push_back(std::move(frame));
  }

  // The last frame is a keyframe; what led to it is free or not.
  void MarkKey(bool free) {
    const int last = static_cast<int>(task_.frames.size()) - 1;
    if (!task_.keyframes.empty() && task_.keyframes.back() == last) return;
    if (!task_.keyframes.empty()) task_.is_free.push_back(free);
    task_.keyframes.push_back(last);
  }

  // The rows at the speed of the physics, without the first, at which the last frame is.
  void AddRows(MotionPhase phase, const Rows& rows) {
    const int count = std::max(1, static_cast<int>(std::lround(rows.seconds() * task_.fps)));
    int before = rows.first();
    for (int i = 1; i <= count; ++i) {
      const int row = rows.AtStep(i, count);
      const Contacts& contacts = rows.ContactsAt(row);
      const bool is_transit = phase == MotionPhase::kContact && !AnyOn(contacts);
      // Keyframes are where fingers touch; without any, the way to the next contact decides.
      const bool changes = !SameFingers(contacts, task_.frames.back().contacts);
      if (changes && AnyOn(task_.frames.back().contacts)) MarkKey(false);
      Add(is_transit ? MotionPhase::kTransit : phase, rows[row], contacts);
      task_.frames.back().X_WB_way = WayPoses(rows, before, row);
      if (i == count || (changes && AnyOn(contacts))) MarkKey(false);
      before = row;
    }
  }

  MotionTask Finish() {
    for (const MotionFrameTask& frame : task_.frames) {
      PREGRASP_CHECK(AreFinite(frame.t, frame.X_WB), frame.t);
    }
    return std::move(task_);
  }

  const MotionFrameTask& last() const { return task_.frames.back(); }

 private:
  std::vector<std::vector<RigidTransform>> WayPoses(const Rows& rows, int from, int to) const {
    const int pieces = std::clamp(to - from, 1, kMaxPosesOfWay - 1);
    std::vector<std::vector<RigidTransform>> poses;
    for (int i = 0; i <= pieces; ++i) {
      poses.push_back(world_.GetPoses(rows[from + (to - from) * i / pieces]));
    }
    return poses;
  }

  const World& world_;
  MotionTask task_;
};

}  // namespace

const char* MotionPhaseName(MotionPhase phase) {
  constexpr std::array<const char*, kNumMotionPhases> kNames{"approach", "contact", "transit",
                                                             "closing", "lift"};
  return kNames[static_cast<int>(phase)];
}

MotionTask WithSteps(const MotionTask& task, int interval, int steps) {
  PREGRASP_CHECK(interval >= 0 && interval < task.num_intervals() && task.is_free[interval],
                 interval);
  PREGRASP_CHECK(steps >= 1, steps);
  const int begin = task.keyframes[interval], end = task.keyframes[interval + 1];
  // A frame between the ends: as the last one of the interval before its end, or the first if there
  // is none: its fingers are those that stay on.
  MotionFrameTask between = task.frames[begin];
  between.contacts = Shared(task.frames[begin].contacts, task.frames[end].contacts);
  between.X_WB_way = {between.X_WB};
  MotionTask other = task;
  other.frames.assign(task.frames.begin(), task.frames.begin() + begin + 1);
  other.frames.insert(other.frames.end(), steps - 1, between);
  other.frames.insert(other.frames.end(), task.frames.begin() + end, task.frames.end());
  for (std::size_t k = interval + 1; k < other.keyframes.size(); ++k) {
    other.keyframes[k] += begin + steps - end;
  }
  for (std::size_t i = 0; i < other.frames.size(); ++i) {
    other.frames[i].t = static_cast<double>(i) / other.fps;
  }
  return other;
}

MotionTask BuildMotionTask(const World& world, const std::vector<TraceRow>& trace,
                           const MotionLift& lift, const MotionTiming& timing) {
  PREGRASP_CHECK(trace.size() >= 2 && lift.trace.size() >= 2, trace.size(), lift.trace.size());
  PREGRASP_CHECK(timing.fps > 0.0, timing.fps);
  const Simulation plan{trace, FindTouches(trace)};
  Simulation lifting{lift.trace, {}};
  for (const TraceRow& row : lift.trace) lifting.contacts.push_back(ContactsOn(row.state));
  TaskBuilder task(world, timing.fps);
  // A finger is put on at the end of one step and is on in the row of the next.
  task.Add(MotionPhase::kApproach, trace.front().state, {});
  task.MarkKey(true);
  const Contacts& first = plan.contacts[1];
  task.Add(AnyOn(first) ? MotionPhase::kContact : MotionPhase::kTransit, trace.front().state,
           first);
  task.MarkKey(true);
  task.AddRows(MotionPhase::kContact, Rows(plan, plan.begin(), FindStill(plan)));

  const Rows handover(lifting, lifting.begin(), lift.closing_t);
  task.AddRows(MotionPhase::kClosing, handover);
  const Rows closing(lifting, lift.closing_t, lift.lift_t);
  task.Add(MotionPhase::kClosing, closing[closing.first()],
           closing.ContactsAt(std::min(closing.first() + 1, closing.last())));
  task.MarkKey(true);
  task.AddRows(MotionPhase::kClosing, closing);
  task.AddRows(MotionPhase::kLift, Rows(lifting, lift.lift_t, lifting.end()));
  return task.Finish();
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

HandWay MakeHandWay(const MotionFrameTask& before, const MotionFrameTask& frame,
                    const HandConfiguration& from, const HandConfiguration& to) {
  HandWay way;
  way.from = from;
  way.to = to;
  way.X_WB = frame.X_WB_way;
  for (int j = 0; j < kNumFingers; ++j) {
    way.touch.touching[j] = before.contacts[j].on || frame.contacts[j].on;
  }
  return way;
}

}  // namespace pregrasp
