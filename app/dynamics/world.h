#pragma once

#include <memory>
#include <vector>

#include "app/dynamics/indices.h"
#include "app/dynamics/step_config.h"
#include "app/dynamics/world_state.h"
#include "app/scene/scene.h"

namespace pregrasp {

/// The world of one scene, built once, immutable and shared by threads: a Simbody multibody system,
/// the contact kernel generated from it, and the scene's collision shapes. Functions are const and
/// deterministic, and any number of threads may call them at once.
class World {
 public:
  /// @param scene  validated and loaded. @throws InputError for a shape that cannot be simulated.
  explicit World(const Scene& scene, const StepConfig& config = {});
  ~World();
  World(World&&) noexcept;

  const Scene& scene() const;
  const StepConfig& config() const;
  int num_movables() const;
  BodyIndex body_index(MovableIndex movable) const;
  /// None for a fixed body.
  MovableIndex movable_index(BodyIndex body) const;

  /// The scene at rest with no finger on.
  WorldState InitialState() const;

  /// Every scene body's pose in `state`, in scene order.
  std::vector<RigidTransform> GetPoses(const WorldState& state) const;

  /// Puts a finger on the object at the surface point nearest to p_OC, its target at the point
  /// itself, with the spring of the scene's fingertips.
  void PutFinger(WorldState& state, Finger finger, const Vector3& p_OC) const;

  /// Gives a finger that is on another stiffness [N/m], above 0, and the damping that belongs to
  /// it. The target of one that touches moves to where the new spring gives the last step's force:
  /// p + f / k, and b v / k on top where the finger moves at v.
  void SetStiffness(WorldState& state, Finger finger, double stiffness) const;

  void LiftFinger(WorldState& state, Finger finger) const;

  /// One step of dt; each finger that is on pulls towards its p_WTarget, taken as the target at the
  /// end of the step. Locks nothing, and allocates nothing once the thread's memory, the state's
  /// cache and `contacts` have grown.
  /// @param contacts  filled with the step's contact points if given.
  Convergence Step(WorldState& state, std::vector<ContactPoint>* contacts = nullptr) const;

  /// The same step, and what it did; slower, as the energies come from Simbody.
  StepTrace StepWithTrace(WorldState& state) const;

  /// The same step computed entirely through Simbody's State and operators: the oracle for Step in
  /// tests, and the certifier of plans.
  Convergence StepWithSimbody(WorldState& state,
                              std::vector<ContactPoint>* contacts = nullptr) const;

  /// Kinetic plus potential energy of the movable bodies [J], by Simbody.
  double CalcEnergy(const WorldState& state) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pregrasp
