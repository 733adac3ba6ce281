#pragma once

#include <memory>
#include <vector>

#include "app/dynamics/motion.h"
#include "app/dynamics/world_state.h"
#include "app/scene/scene.h"

namespace pregrasp {

/// Of all movable bodies [J].
struct Energy {
  double kinetic = 0.0, potential = 0.0;
};

/// The scene's movable bodies as a Simbody multibody system, with one State to work in. The only
/// place in app/dynamics that knows Simbody. Not to be shared between threads while in use.
class SimbodyModel {
 public:
  /// @throws InputError for mass properties that no body can have.
  explicit SimbodyModel(const Scene& scene);
  ~SimbodyModel();

  int num_bodies() const;

  /// Mass properties of movable `i`, as Simbody holds them.
  MassProperties GetMassProperties(int i) const;

  /// The movables' poses and velocities (zero) in the system's default state.
  std::vector<BodyState> GetDefaultState() const;

  /// Potential energy is 0 at W's origin.
  Energy CalcEnergy(const std::vector<BodyState>& bodies, const Vector3& gravity);

  /// Begins a step: takes poses and velocities, adds the impulses of gravity and of an outer force
  /// on the first body's centre of mass, and gives the motions that the contacts start from.
  void Predict(const std::vector<BodyState>& bodies, const std::vector<BodyKernel>& kernels,
               const Vector3& gravity, const Vector3& f_Ocm_W, double dt,
               std::vector<BodyMotion>* motions);

  /// Ends the step that Predict began: applies the impulses and moves the bodies.
  void Advance(const std::vector<BodyImpulse>& impulses, double dt, std::vector<BodyState>* bodies);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pregrasp
