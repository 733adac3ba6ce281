#include "app/job/simulation.h"

#include <fmt/format.h>

#include <cmath>

#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/core/text.h"

namespace pregrasp {
namespace {

constexpr double kMaxTarget = 1000.0;  // [m], of a coordinate: ten times the largest shape

}  // namespace

Simulation::Simulation(std::shared_ptr<const World> world, WorldState start, bool traced)
    : world_(std::move(world)), traced_(traced) {
  past_.push_back(std::make_shared<const Moment>(Moment{std::move(start), {}}));
}

double Simulation::CalcMaxPenetration() const {
  double deepest = 0.0;
  for (const auto& moment : past_) {
    for (const ContactPoint& contact : moment->trace.contacts) {
      deepest = std::max(deepest, -contact.phi);
    }
  }
  return deepest;
}

void Simulation::ReplaceState(WorldState state) {
  past_.back() = std::make_shared<const Moment>(Moment{std::move(state), past_.back()->trace});
}

void Simulation::StepOnce(WorldState state) {
  ThrowIfInterrupted();
  Moment next{std::move(state), {}};
  if (traced_) {
    next.trace = world_->StepWithTrace(next.state);
  } else {
    world_->Step(next.state, &next.trace.contacts);
  }
  past_.push_back(std::make_shared<const Moment>(std::move(next)));
}

void Simulation::RequireRoom(int steps) const {
  const double seconds = (past_.size() + static_cast<double>(steps)) * world_->config().dt;
  if (seconds > kMaxSeconds) {
    throw InputError("", "seconds", fmt::format("at most {} s in one simulation", kMaxSeconds),
                     fmt::format("{:.6g} s", seconds));
  }
}

int Simulation::StepsIn(double seconds) const {
  if (!(seconds >= 0.0 && seconds <= kMaxSeconds)) {
    throw InputError("", "seconds", fmt::format("0 to {} s", kMaxSeconds), FormatDouble(seconds));
  }
  return static_cast<int>(std::lround(seconds / world_->config().dt));
}

void Simulation::Touch(Finger finger, const Vector3& p_OC) {
  WorldState touched = state();
  world_->PutFinger(touched, finger, p_OC);
  ReplaceState(std::move(touched));
}

void Simulation::Lift(Finger finger) {
  WorldState lifted = state();
  world_->LiftFinger(lifted, finger);
  ReplaceState(std::move(lifted));
}

void Simulation::Move(Finger finger, const Vector3& p_WTarget, double seconds) {
  const int index = static_cast<int>(finger);
  if (!state().fingers[index].on) {
    throw InputError("", "finger", "a finger that touches",
                     fmt::format("\"{}\", which is off", FingerName(finger)));
  }
  if (!(seconds > 0.0)) {
    throw InputError("", "seconds", "a time above 0 s", FormatDouble(seconds));
  }
  if (!(p_WTarget.cwiseAbs().maxCoeff() <= kMaxTarget)) {
    throw InputError("", "target", fmt::format("a point within {} m", kMaxTarget),
                     FormatDouble(p_WTarget.cwiseAbs().maxCoeff()) + " m");
  }
  const int steps = std::max(1, StepsIn(seconds));
  RequireRoom(steps);
  const Vector3 from = state().fingers[index].p_WTarget;
  for (int i = 1; i <= steps; ++i) {
    WorldState next = state();
    next.fingers[index].p_WTarget = from + (p_WTarget - from) * (static_cast<double>(i) / steps);
    StepOnce(std::move(next));
  }
}

void Simulation::Step(int steps) {
  if (steps < 0) throw InputError("", "steps", "a count of at least 0", std::to_string(steps));
  RequireRoom(steps);
  for (int i = 0; i < steps; ++i) StepOnce(state());
}

void Simulation::Back(int steps) {
  if (steps < 0 || steps >= num_states()) {
    throw InputError("", "steps", fmt::format("0 to {} steps", num_states() - 1),
                     std::to_string(steps));
  }
  past_.resize(past_.size() - steps);
}

}  // namespace pregrasp
