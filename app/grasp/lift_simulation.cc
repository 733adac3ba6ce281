#include "app/grasp/lift_simulation.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/core/check.h"
#include "app/core/ease.h"
#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/core/text.h"
#include "app/dynamics/tip_overlap.h"

namespace pregrasp {
namespace {

// The definition of "held" (design, section 4): no settings, so that none can turn a check off.
constexpr double kMaxShift = 0.01;         // [m]
constexpr double kMaxTurnDeg = 15.0;       // [degrees]
constexpr double kUntouchedSeconds = 0.3;  // at the end
constexpr double kMaxUnresolved = 1e-3;    // [m], as of a certified plan
constexpr double kPushSeconds = 0.3, kRestSeconds = 0.5;
constexpr double kSameContact = 2e-3;  // a pressing finger that the grasp uses where it is [m]
constexpr double kWorldRadius = 5.0;   // an object farther from its start than this has left [m]

bool Presses(const FingertipState& tip, const GraspContact& contact) {
  return tip.on && tip.touching && (tip.p_OC - contact.p_OC).norm() < kSameContact;
}

bool Touches(const ContactPoint& contact) {
  return contact.f_W.squaredNorm() > 0.0 || contact.phi <= 0.0;
}

// Steps the world along the fingers' targets and keeps the books of a LiftOutcome.
class Lifter {
 public:
  Lifter(const World& world, const EnvironmentDistance& environment, const WorldState& start,
         Stepper stepper, bool trace)
      : world_(world),
        environment_(environment),
        stepper_(stepper),
        keeps_trace_(trace),
        state_(start),
        X_WO_start_(start.bodies.front().X_WB()) {
    if (keeps_trace_) outcome_.trace.push_back({state_, {}});
  }

  void HandOver(const LiftGrip& grip, double seconds) {
    std::array<bool, kNumFingers> stays{};
    for (const GraspContact& contact : grip.contacts) {
      const int f = static_cast<int>(contact.finger);
      stays[f] = Presses(state_.fingers[f], contact);
    }
    std::array<Vector3, kNumFingers> to;
    for (int f = 0; f < kNumFingers; ++f) {
      FingertipState& tip = state_.fingers[f];
      if (!tip.on) continue;
      world_.SetStiffness(state_, static_cast<Finger>(f), grip.stiffness);
      to[f] = stays[f] ? tip.p_WTarget : tip.p_WF;
    }
    MoveTargets(to, seconds);
    for (int f = 0; f < kNumFingers; ++f) {
      if (state_.fingers[f].on && !stays[f]) world_.LiftFinger(state_, static_cast<Finger>(f));
    }
  }

  void Close(const LiftGrip& grip, double seconds) {
    outcome_.closing_t = state_.t;
    const RigidTransform X_WO = state_.bodies.front().X_WB();
    std::array<Vector3, kNumFingers> to;
    for (std::size_t i = 0; i < grip.contacts.size(); ++i) {
      const Finger finger = grip.contacts[i].finger;
      const int f = static_cast<int>(finger);
      if (!state_.fingers[f].on) {
        world_.PutFinger(state_, finger, grip.contacts[i].p_OC);
        world_.SetStiffness(state_, finger, grip.stiffness);
      }
      const Vector3 f_O = grip.forces_O.row(static_cast<Eigen::Index>(i));
      to[f] = X_WO * state_.fingers[f].p_OC + X_WO.linear() * f_O / grip.stiffness;
    }
    MoveTargets(to, seconds);
  }

  void Lift(const LiftWay& way, double seconds) {
    outcome_.lift_t = state_.t;
    direction_W_ = way.direction_W;
    Move(way.length * way.direction_W, seconds);
    if (!way.rise_W.isZero(0.0)) Move(way.rise_W, seconds);
  }

  void Hold(double seconds) {
    outcome_.hold_t = state_.t;
    Run(seconds, [](int, double) {});
  }

  void Push(const Vector3& force_W) {
    state_.f_Ocm_W = force_W;
    Hold(kPushSeconds);
    state_.f_Ocm_W.setZero();
    Hold(kRestSeconds);
  }

  LiftOutcome Finish() {
    const Vector3 way = state_.bodies.front().p_WB - X_WO_start_.translation();
    outcome_.height = way.dot(direction_W_);
    for (const FingertipState& tip : state_.fingers) {
      if (tip.on) outcome_.slip = std::max(outcome_.slip, tip.slip);
    }
    if (touched_body_ && !(state_.t - touched_t_ > kUntouchedSeconds)) {
      outcome_.touching_body = touched_body_;
    }
    outcome_.neighbours = CalcNeighbourMotion(world_, state_);
    outcome_.end = state_;
    return std::move(outcome_);
  }

 private:
  // In straight lines, those of the fingers that are on.
  void MoveTargets(const std::array<Vector3, kNumFingers>& to, double seconds) {
    const std::array<Vector3, kNumFingers> from = Targets();
    Run(seconds,
        [&](int f, double s) { state_.fingers[f].p_WTarget = from[f] + s * (to[f] - from[f]); });
  }

  std::array<Vector3, kNumFingers> Targets() const {
    std::array<Vector3, kNumFingers> targets;
    for (int f = 0; f < kNumFingers; ++f) targets[f] = state_.fingers[f].p_WTarget;
    return targets;
  }

  void Move(const Vector3& shift, double seconds) {
    const std::array<Vector3, kNumFingers> from = Targets();
    const Vector3 offset = offset_;
    Run(seconds, [&](int f, double s) {
      state_.fingers[f].p_WTarget = from[f] + Ease(s) * shift;
      offset_ = offset + Ease(s) * shift;
    });
  }

  template <typename SetTarget>
  void Run(double seconds, const SetTarget& set_target) {
    const int steps = static_cast<int>(std::lround(seconds / world_.config().dt));
    for (int i = 1; i <= steps && !outcome_.diverged; ++i) {
      for (int f = 0; f < kNumFingers; ++f) {
        if (state_.fingers[f].on) set_target(f, static_cast<double>(i) / steps);
      }
      Step();
    }
  }

  void Step() {
    ThrowIfInterrupted();
    contacts_.clear();
    before_ = state_;
    const Convergence convergence = stepper_ == Stepper::kKernel
                                        ? world_.Step(state_, &contacts_)
                                        : world_.StepWithSimbody(state_, &contacts_);
    if (!convergence.converged) {
      ++outcome_.not_converged;
      outcome_.unresolved += world_.config().dt * convergence.residual;
    }
    const BodyState& object = state_.bodies.front();
    const bool is_finite = object.p_WB.allFinite() && object.q_WB.coeffs().allFinite() &&
                           object.v_WB.allFinite() && object.w_WB.allFinite();
    if (!is_finite || !((object.p_WB - X_WO_start_.translation()).norm() < kWorldRadius)) {
      outcome_.diverged = true;
      state_ = before_;  // the last that means something
      return;
    }
    KeepBooks();
    if (keeps_trace_) outcome_.trace.push_back({state_, contacts_});
  }

  void KeepBooks() {
    const RigidTransform X_WO = state_.bodies.front().X_WB();
    const Vector3 p_WO = X_WO_start_.translation() + offset_;  // where it should be
    outcome_.end_shift = (X_WO.translation() - p_WO).norm();
    outcome_.end_turn_deg = RadToDeg(RotationAngle(X_WO_start_.linear(), X_WO.linear()));
    outcome_.shift = std::max(outcome_.shift, outcome_.end_shift);
    outcome_.turn_deg = std::max(outcome_.turn_deg, outcome_.end_turn_deg);
    for (const ContactPoint& contact : contacts_) {
      if (contact.body_a != kObjectBody || !Touches(contact)) continue;
      touched_t_ = state_.t;
      touched_body_ = contact.body_b;
    }
    const std::vector<RigidTransform> X_WB = world_.GetPoses(state_);
    for (int f = 0; f < kNumFingers; ++f) {
      if (!state_.fingers[f].on) continue;
      const Finger finger = static_cast<Finger>(f);
      const double overlap =
          CalcTipOverlap(state_, finger, world_.scene().tips.radius(finger), X_WB, environment_);
      if (overlap > outcome_.tip_overlap) {
        outcome_.tip_overlap = overlap;
        outcome_.deepest_tip = finger;
      }
    }
    if (world_.num_movables() == 1) return;
    const NeighbourMotion motion = CalcNeighbourMotion(world_, state_);
    outcome_.neighbour_moved = std::max(outcome_.neighbour_moved, motion.moved);
    outcome_.neighbour_turned_deg = std::max(outcome_.neighbour_turned_deg, motion.turned_deg);
  }

  const World& world_;
  const EnvironmentDistance& environment_;
  Stepper stepper_;
  bool keeps_trace_;
  WorldState state_, before_;
  RigidTransform X_WO_start_;
  Vector3 direction_W_ = Vector3::UnitZ();
  Vector3 offset_ = Vector3::Zero();  // of where the object should be from its start
  std::vector<ContactPoint> contacts_;
  double touched_t_ = 0.0;
  std::optional<BodyIndex> touched_body_;
  LiftOutcome outcome_;
};

void RequireSeconds(const char* field, double seconds) {
  if (!(seconds > 0.0 && seconds <= 60.0)) {
    throw InputError("", field, "a time above 0 and at most 60 s", FormatDouble(seconds));
  }
}

}  // namespace

void LiftConfig::Validate() const {
  way.Validate();
  forces.Validate();
  RequireSeconds("handover_seconds", handover_seconds);
  RequireSeconds("closing_seconds", closing_seconds);
  RequireSeconds("lift_seconds", lift_seconds);
  if (!(hold_seconds >= kUntouchedSeconds && hold_seconds <= 60.0)) {
    throw InputError("", "hold_seconds", "a time from 0.3 to 60 s", FormatDouble(hold_seconds));
  }
}

const char* LiftReasonName(LiftReason reason) {
  constexpr const char* kNames[] = {
      "no_free_direction", "never_free",      "no_forces",     "gives_way",     "diverged",
      "tip_overlap",       "does_not_follow", "still_touches", "not_converged", "step_dependent"};
  return kNames[static_cast<int>(reason)];
}

std::vector<LiftReason> JudgeLift(const LiftOutcome& outcome) {
  if (outcome.diverged) return {LiftReason::kDiverged};
  std::vector<LiftReason> reasons;
  if (!(outcome.tip_overlap <= kTipOverlapAllowed)) reasons.push_back(LiftReason::kTipOverlap);
  if (!(outcome.shift <= kMaxShift && outcome.turn_deg <= kMaxTurnDeg)) {
    reasons.push_back(LiftReason::kDoesNotFollow);
  }
  if (outcome.touching_body) reasons.push_back(LiftReason::kStillTouches);
  if (!(outcome.unresolved <= kMaxUnresolved)) reasons.push_back(LiftReason::kNotConverged);
  return reasons;
}

bool WithstandsPush(const LiftOutcome& outcome) {
  return !outcome.diverged && outcome.end_shift <= kMaxShift &&
         outcome.end_turn_deg <= kMaxTurnDeg && outcome.tip_overlap <= kTipOverlapAllowed &&
         outcome.unresolved <= kMaxUnresolved && !outcome.touching_body;
}

LiftOutcome SimulateLift(const World& world, const EnvironmentDistance& environment,
                         const WorldState& start, const LiftGrip& grip, const LiftWay& way,
                         const LiftConfig& config, Stepper stepper, bool trace) {
  PREGRASP_CHECK(way.is_free());
  PREGRASP_CHECK(grip.forces_O.rows() == static_cast<Eigen::Index>(grip.contacts.size()));
  Lifter lifter(world, environment, start, stepper, trace);
  lifter.HandOver(grip, config.handover_seconds);
  lifter.Close(grip, config.closing_seconds);
  lifter.Lift(way, config.lift_seconds * way.length / config.way.height);
  lifter.Hold(config.hold_seconds);
  return lifter.Finish();
}

LiftOutcome SimulatePush(const World& world, const EnvironmentDistance& environment,
                         const WorldState& top, const Vector3& force_W) {
  Lifter lifter(world, environment, top, Stepper::kKernel, false);
  lifter.Push(force_W);
  return lifter.Finish();
}

std::vector<GraspContact> MoveToPressing(const WorldState& state,
                                         std::vector<GraspContact> contacts) {
  for (GraspContact& contact : contacts) {
    const FingertipState& tip = state.fingers[static_cast<int>(contact.finger)];
    if (!Presses(tip, contact)) continue;
    contact.p_OC = tip.p_OC;
    contact.nhat_O = tip.nhat_O;
  }
  return contacts;
}

}  // namespace pregrasp
