#include "app/trajectory/simulate_plan.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/core/check.h"
#include "app/core/finite.h"
#include "app/core/interrupt.h"
#include "app/dynamics/tip_overlap.h"

namespace pregrasp {
namespace {

// Steps between checks of the fingertip spheres while planning; certification checks each step.
constexpr int kTipCheckEvery = 4;
constexpr double kWorldRadius = 5.0;  // an object farther from its start than this has left [m]

RigidTransform ContactFrame(const RigidTransform& X_WO, const FingertipState& tip) {
  return X_WO * MakeTransform(FrameFromNormal(tip.nhat_O), tip.p_OC);
}

bool IsFiniteState(const WorldState& state) {
  for (const BodyState& body : state.bodies) {
    if (!AreFinite(body.p_WB, body.q_WB, body.v_WB, body.w_WB)) return false;
  }
  for (const FingertipState& tip : state.fingers) {
    if (tip.on && !AreFinite(tip.p_OC, tip.nhat_O, tip.p_WTarget, tip.f_W)) return false;
  }
  return true;
}

// Steps the world along targets and keeps the books of a PlanOutcome.
class PlanRunner {
 public:
  PlanRunner(const World& world, const EnvironmentDistance& environment, const WorldState& start,
             const PlanTiming& timing, Stepper stepper, std::vector<TraceRow>* trace)
      : world_(world),
        environment_(environment),
        timing_(timing),
        stepper_(stepper),
        trace_(trace),
        state_(start),
        start_(start),
        finite_(start) {
    if (trace_) trace_->push_back({state_, FindContacts()});
    PREGRASP_CHECK(timing.knots >= 1, timing.knots);
    steps_per_knot_ = StepsIn(timing.stage_seconds / timing.knots);
    steps_in_hold_ = StepsIn(timing.hold_seconds);
    steps_in_window_ = std::max(1, StepsIn(kTipWindow));
  }

  const WorldState& state() const { return state_; }
  bool diverged() const { return outcome_.diverged; }
  void Diverge() { outcome_.diverged = true; }

  // Puts the fingers of a stage on or off. F has on, kept and contact. Those that are not kept let
  // go at once; those that come are on once the hand has had the time to bring them (CalcWait).
  // With `only_where_they_fit`, a finger whose tip does not fit where it is asked to be stays away.
  template <typename F>
  void StartStage(const std::array<F, kNumPlanningFingers>& fingers, bool only_where_they_fit) {
    for (int j = 0; j < kNumPlanningFingers; ++j) {
      if (state_.fingers[j].on) p_WLast_[j] = CalcContactPlace(j);
    }
    const double seconds = CalcWait(fingers);
    for (int j = 0; j < kNumPlanningFingers; ++j) {
      const bool stays = fingers[j].on && fingers[j].kept;
      if (!stays) world_.LiftFinger(state_, static_cast<Finger>(j));
    }
    finite_ = state_;
    for (int i = StepsIn(seconds); i > 0 && !outcome_.diverged; --i) Step();
    outcome_.waits.push_back(seconds);
    outcome_.plan.stages.emplace_back();
    for (int j = 0; j < kNumPlanningFingers; ++j) {
      const Finger finger = static_cast<Finger>(j);
      auto& used = outcome_.plan.stages.back()[j];
      used.contact = fingers[j].contact;
      if (fingers[j].on && !fingers[j].kept) {
        world_.PutFinger(state_, finger, fingers[j].contact.p_OC);
        if (only_where_they_fit && !Fits(finger)) world_.LiftFinger(state_, finger);
      }
      used.on = state_.fingers[j].on;
      used.kept = fingers[j].kept && used.on;
    }
    outcome_.stage_starts.push_back(state_);
  }

  // Moves the targets of the fingers that are on in straight lines to `p_WTargets`.
  void RunKnot(const std::array<Vector3, kNumPlanningFingers>& p_WTargets) {
    finite_ = state_;
    std::array<Vector3, kNumPlanningFingers> from;
    for (int j = 0; j < kNumPlanningFingers; ++j) {
      from[j] = state_.fingers[j].p_WTarget;
      if (state_.fingers[j].on) {
        PREGRASP_CHECK(IsFinite(p_WTargets[j]), j, p_WTargets[j].transpose());
        outcome_.plan.stages.back()[j].p_WTargets.push_back(p_WTargets[j]);
      }
    }
    for (int i = 1; i <= steps_per_knot_ && !outcome_.diverged; ++i) {
      const double s = static_cast<double>(i) / steps_per_knot_;
      for (int j = 0; j < kNumPlanningFingers; ++j) {
        if (state_.fingers[j].on) {
          state_.fingers[j].p_WTarget = from[j] + s * (p_WTargets[j] - from[j]);
        }
      }
      Step();
    }
  }

  PlanOutcome Finish() {
    outcome_.hold_start = finite_ = state_;
    for (int i = 0; i < steps_in_hold_ && !outcome_.diverged; ++i) Step();
    outcome_.end = state_;
    outcome_.seconds = state_.t - start_.t;
    PREGRASP_CHECK(IsFiniteState(outcome_.end) && IsFiniteState(outcome_.hold_start));
    PREGRASP_CHECK(AreFinite(outcome_.seconds, outcome_.contact_seconds, outcome_.effort,
                             outcome_.max_force, outcome_.max_speed, outcome_.max_tip_speed,
                             outcome_.max_tip_acceleration, outcome_.max_penetration,
                             outcome_.max_tip_overlap, outcome_.min_tip_gap));
    return std::move(outcome_);
  }

 private:
  int StepsIn(double seconds) const {
    constexpr double kMaxSeconds = 1000.0;  // a row of the trace for each step
    PREGRASP_CHECK(seconds >= 0.0 && seconds <= kMaxSeconds, seconds);
    return static_cast<int>(std::lround(seconds / world_.config().dt));
  }

  void Step() {
    ThrowIfInterrupted();
    contacts_.clear();
    if (stepper_ == Stepper::kKernel) {
      AddConvergence(world_.Step(state_, trace_ ? &contacts_ : nullptr));
    } else {
      AddConvergence(world_.StepWithSimbody(state_, &contacts_));
    }
    if (!IsFiniteState(state_)) {  // the outcome is the last that was finite
      state_ = finite_;
      outcome_.diverged = true;
      return;
    }
    KeepBooks();
    if (trace_) trace_->push_back({state_, contacts_});
  }

  Vector3 CalcContactPlace(int finger) const {
    return state_.bodies.front().X_WB() * state_.fingers[finger].p_OC;
  }

  // What the bodies touch where they stand: the contacts of a step that changes nothing here.
  std::vector<ContactPoint> FindContacts() const {
    WorldState state = state_;
    std::vector<ContactPoint> contacts;
    if (stepper_ == Stepper::kKernel) {
      world_.Step(state, &contacts);
    } else {
      world_.StepWithSimbody(state, &contacts);
    }
    return contacts;
  }

  // How long the hand needs to bring the fingers of a stage to new contacts: none at the plan's
  // start, where it has all the time. A finger comes from where it was on last, or, if it has not
  // been on, from where the other one was.
  template <typename F>
  double CalcWait(const std::array<F, kNumPlanningFingers>& fingers) const {
    double seconds = 0.0;
    for (int j = 0; j < kNumPlanningFingers; ++j) {
      if (!fingers[j].on || fingers[j].kept) continue;
      const auto& from = p_WLast_[j] ? p_WLast_[j] : p_WLast_[1 - j];
      if (!from) continue;
      const Vector3 to = state_.bodies.front().X_WB() * fingers[j].contact.p_OC;
      seconds = std::max(seconds,
                         timing_.transfer_seconds + (to - *from).norm() / timing_.transfer_speed);
    }
    return seconds;
  }

  bool Fits(Finger finger) const {
    return CalcTipOverlap(state_, finger, tips_.radius(finger), world_.GetPoses(state_),
                          environment_) <= kTipOverlapAllowed;
  }

  void AddConvergence(const Convergence& convergence) {
    if (convergence.converged) return;
    const double dt = world_.config().dt;
    ++outcome_.not_converged;
    outcome_.max_residual = std::max(outcome_.max_residual, convergence.residual);
    outcome_.unresolved += dt * convergence.residual;
  }

  void KeepBooks() {
    const double dt = world_.config().dt;
    const BodyState& object = state_.bodies.front();
    outcome_.max_speed = std::max(outcome_.max_speed, object.v_WB.norm());
    for (const ContactPoint& contact : contacts_) {
      outcome_.max_penetration = std::max(outcome_.max_penetration, -contact.phi);
    }
    for (const FingertipState& tip : state_.fingers) {
      if (!tip.on || !tip.touching) continue;
      const double force = tip.f_W.norm();
      outcome_.contact_seconds += dt;
      if (tip.slipping) outcome_.slip_seconds += dt;
      outcome_.effort += force * dt;
      outcome_.max_force = std::max(outcome_.max_force, force);
    }
    if (state_.step % steps_in_window_ == 0) FollowTips();
    const int tip_check_every = stepper_ == Stepper::kSimbody ? 1 : kTipCheckEvery;
    if (state_.step % tip_check_every == 0) CheckTips(tip_check_every * dt);
    const Vector3 travelled = object.p_WB - start_.bodies.front().p_WB;
    if (!(travelled.norm() <= kWorldRadius)) outcome_.diverged = true;
  }

  // By how much the tips that touch have moved in the last windows.
  void FollowTips() {
    const double seconds = steps_in_window_ * world_.config().dt;
    for (int j = 0; j < kNumPlanningFingers; ++j) {
      const FingertipState& tip = state_.fingers[j];
      std::array<std::optional<Vector3>, 3>& p = p_WTips_[j];
      p = {p[1], p[2], std::nullopt};
      if (!tip.on || !tip.touching) continue;
      p[2] = tip.p_WF;
      if (!p[1]) continue;
      const Vector3 v = (*p[2] - *p[1]) / seconds;
      outcome_.max_tip_speed = std::max(outcome_.max_tip_speed, v.norm());
      if (!p[0]) continue;
      const Vector3 a = (v - (*p[1] - *p[0]) / seconds) / seconds;
      outcome_.max_tip_acceleration = std::max(outcome_.max_tip_acceleration, a.norm());
    }
  }

  void CheckTips(double seconds) {
    const std::vector<RigidTransform> X_WB = world_.GetPoses(state_);
    bool overlaps = false;
    for (int j = 0; j < kNumPlanningFingers; ++j) {
      if (!state_.fingers[j].on) continue;
      const double overlap =
          CalcTipOverlap(state_, static_cast<Finger>(j), tips_.radii[j], X_WB, environment_);
      PREGRASP_CHECK(std::isfinite(overlap), j, overlap);  // std::max passes over a NaN
      outcome_.max_tip_overlap = std::max(outcome_.max_tip_overlap, overlap);
      overlaps |= !(overlap <= kTipOverlapAllowed);
    }
    if (overlaps) outcome_.tip_overlap_seconds += seconds;
    if (state_.fingers[0].on && state_.fingers[1].on) {
      const auto centre_O = [&](int j) {
        const FingertipState& tip = state_.fingers[j];
        return tips_.Centre(static_cast<Finger>(j), tip.p_OC, tip.nhat_O);
      };
      const double gap = tips_.CalcGap(Finger::kThumb, centre_O(0), Finger::kIndex, centre_O(1));
      outcome_.min_tip_gap = std::min(outcome_.min_tip_gap, gap);
    }
  }

  const World& world_;
  const TipSpheres& tips_ = world_.scene().tips;
  const EnvironmentDistance& environment_;
  const PlanTiming& timing_;
  Stepper stepper_;
  std::vector<TraceRow>* trace_;
  WorldState state_;
  WorldState start_;
  WorldState finite_;  // at the start of the knot, of the wait or of the hold
  std::array<std::optional<Vector3>, kNumPlanningFingers> p_WLast_;  // contacts, when last on
  std::vector<ContactPoint> contacts_;
  PlanOutcome outcome_;
  int steps_per_knot_ = 0, steps_in_hold_ = 0, steps_in_window_ = 1;
  /// Where each tip touched at the last ends of windows; nothing where it did not.
  std::array<std::array<std::optional<Vector3>, 3>, kNumPlanningFingers> p_WTips_;
};

}  // namespace

PlanOutcome SimulatePlan(const World& world, const EnvironmentDistance& environment,
                         const WorldState& start, const RelativePlan& plan,
                         const PlanTiming& timing, std::vector<TraceRow>* trace) {
  PlanRunner runner(world, environment, start, timing, Stepper::kKernel, trace);
  for (const auto& stage : plan.stages) {
    runner.StartStage(stage, true);
    for (int k = 0; k < timing.knots && !runner.diverged(); ++k) {
      const WorldState& state = runner.state();
      const RigidTransform X_WO = state.bodies.front().X_WB();
      std::array<Vector3, kNumPlanningFingers> p_WTargets;
      for (int j = 0; j < kNumPlanningFingers; ++j) {
        const FingertipState& tip = state.fingers[j];
        if (!tip.on) continue;
        const FingerStage::Knot& knot = stage[j].knots.at(k);
        const Vector3 deflection(knot.tangent.x(), knot.tangent.y(), -knot.depth);
        p_WTargets[j] = ContactFrame(X_WO, tip) * deflection + knot.travel_W;
      }
      runner.RunKnot(p_WTargets);
    }
  }
  return runner.Finish();
}

PlanOutcome SimulatePlan(const World& world, const EnvironmentDistance& environment,
                         const WorldState& start, const WorldPlan& plan, const PlanTiming& timing,
                         Stepper stepper, std::vector<TraceRow>* trace) {
  PlanRunner runner(world, environment, start, timing, stepper, trace);
  for (const auto& stage : plan.stages) {
    runner.StartStage(stage, false);
    for (int k = 0; k < timing.knots && !runner.diverged(); ++k) {
      std::array<Vector3, kNumPlanningFingers> p_WTargets;
      bool known = true;
      for (int j = 0; j < kNumPlanningFingers; ++j) {
        if (!stage[j].on) continue;
        known = known && k < std::ssize(stage[j].p_WTargets);
        if (known) p_WTargets[j] = stage[j].p_WTargets[k];
      }
      known ? runner.RunKnot(p_WTargets) : runner.Diverge();
    }
  }
  return runner.Finish();
}

Released SimulateRelease(const World& world, WorldState state) {
  constexpr double kSeconds = 1.0;
  constexpr double kMaxShift = 0.01;  // [m]
  constexpr double kMaxTurnDeg = 5.0;
  for (int f = 0; f < kNumFingers; ++f) world.LiftFinger(state, static_cast<Finger>(f));
  const RigidTransform X_WO = state.bodies.front().X_WB();
  const int steps = static_cast<int>(std::lround(kSeconds / world.config().dt));
  for (int i = 0; i < steps; ++i) {
    ThrowIfInterrupted();
    world.Step(state);
  }
  const RigidTransform X_WO_end = state.bodies.front().X_WB();
  Released release;
  release.shift = (X_WO_end.translation() - X_WO.translation()).norm();
  release.turn_deg = RadToDeg(RotationAngle(X_WO.linear(), X_WO_end.linear()));
  PREGRASP_CHECK(AreFinite(release.shift, release.turn_deg), release.shift, release.turn_deg);
  release.stays = release.shift < kMaxShift && release.turn_deg < kMaxTurnDeg;
  return release;
}

}  // namespace pregrasp
