#pragma once

#include <memory>

#include "app/hand/hand_kinematics.h"

namespace SimTK {
class MobilizedBody;
class MultibodySystem;
class SimbodyMatterSubsystem;
class State;
}  // namespace SimTK

namespace pregrasp {

/// The same hand as a Simbody multibody system, one Free and 22 Pin mobilizers with the model's
/// masses: the reference for HandPose and its Jacobians, and the hand of dynamic simulations.
/// Simbody orders a Free's speeds rotation first; here they are in HandVector's order.
class HandSimbody {
 public:
  explicit HandSimbody(const HandModel& hand);
  ~HandSimbody();
  HandSimbody(HandSimbody&&) noexcept;

  /// Poses the hand; the queries below refer to it.
  void SetConfiguration(const HandConfiguration& configuration);

  RigidTransform CalcLinkPose(int link) const;
  PointJacobian CalcPointJacobian(int link, const Vector3& p_L) const;
  double CalcTotalMass() const;

  const SimTK::MultibodySystem& system() const;
  const SimTK::SimbodyMatterSubsystem& matter() const;
  const SimTK::MobilizedBody& body(int link) const;
  SimTK::State& state();
  /// The palm and joint values of a Simbody state of this system.
  HandConfiguration GetConfiguration(const SimTK::State& state) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pregrasp
