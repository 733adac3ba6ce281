#pragma once

#include <memory>
#include <vector>

#include "app/dynamics/world.h"

namespace pregrasp {

/// A world stepped by hand, with its past: a copyable value, so that a copy is a fork. Copies share
/// the past and the world.
class Simulation {
 public:
  /// The longest past that is kept [s]; about 3 kB a step.
  static constexpr double kMaxSeconds = 300.0;

  /// @param traced  whether each step also tells its energies, for which it takes up to ten times
  /// as long.
  Simulation(std::shared_ptr<const World> world, WorldState start, bool traced = false);

  const World& world() const { return *world_; }
  const WorldState& state() const { return past_.back()->state; }
  /// The contact points of the step that led here; none at the start.
  const std::vector<ContactPoint>& contacts() const { return past_.back()->trace.contacts; }
  /// Every physics step from the start to now, the start included.
  int num_states() const { return static_cast<int>(past_.size()); }
  const WorldState& state_at(int index) const { return past_[index]->state; }
  /// Of the step that led there.
  const std::vector<ContactPoint>& contacts_at(int index) const {
    return past_[index]->trace.contacts;
  }

  bool traced() const { return traced_; }
  /// What the step that led there did, if this simulation is traced and `index` is not the start.
  const StepTrace& trace_at(int index) const { return past_[index]->trace; }

  /// The deepest overlap of two bodies before any of the past steps [m].
  double CalcMaxPenetration() const;

  /// Puts a finger on the object at the surface point nearest to p_OC, without force yet.
  void Touch(Finger finger, const Vector3& p_OC);
  void Lift(Finger finger);

  /// Moves where the finger's spring pulls, evenly over `seconds`, to p_WTarget.
  /// @throws InputError if the finger is off, seconds are not above 0, or the target is not within
  /// 1000 m; Interrupted, as Step.
  void Move(Finger finger, const Vector3& p_WTarget, double seconds);

  /// Physics steps with the targets where they are.
  /// @throws InputError below 0 or beyond kMaxSeconds; Interrupted, with what was stepped kept.
  void Step(int steps);

  /// As many steps as `seconds` take, rounded.
  int StepsIn(double seconds) const;

  /// Takes physics steps back, exactly. @throws InputError when there are fewer.
  void Back(int steps);

 private:
  struct Moment {
    WorldState state;
    StepTrace trace;  ///< its contacts alone where the simulation is not traced
  };

  void StepOnce(WorldState state);
  void ReplaceState(WorldState state);
  void RequireRoom(int steps) const;

  std::shared_ptr<const World> world_;
  std::vector<std::shared_ptr<const Moment>> past_;
  bool traced_;
};

}  // namespace pregrasp
