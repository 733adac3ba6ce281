#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "app/core/math.h"
#include "app/dynamics/indices.h"
#include "app/scene/finger.h"

namespace pregrasp {

/// Pose and velocity of one movable body: frame B in W; w_WB, v_WB of B's origin, expressed in W.
struct BodyState {
  Quaternion q_WB = Quaternion::Identity();
  Vector3 p_WB = Vector3::Zero();
  Vector3 w_WB = Vector3::Zero();
  Vector3 v_WB = Vector3::Zero();

  RigidTransform X_WB() const { return MakeTransform(q_WB, p_WB); }
};

/// One finger: a massless point held by a spring to a target, touching the object from
/// outside with a friction cone. The law is the paper's f = -k (p - p_target), with damping,
/// f.n >= 0, |f_t| <= mu f_n, |f| <= cap; app/dynamics/README.md states it in full.
struct FingertipState {
  bool on = false;
  /// Contact point on the object's surface; moves when the finger slips. Of a finger that does not
  /// touch: the surface point nearest to it.
  Vector3 p_OC = Vector3::Zero();
  Vector3 nhat_O = Vector3::UnitZ();    ///< outward surface normal there
  Vector3 p_WF = Vector3::Zero();       ///< the fingertip point; equals X_WO p_OC while it touches
  Vector3 p_WTarget = Vector3::Zero();  ///< where the spring pulls
  double stiffness = 0.0;               ///< k of the spring [N/m]
  double damping = 0.0;                 ///< b of the damper [N s/m]
  Vector3 f_W = Vector3::Zero();        ///< force on the object over the last step [N]
  bool touching = false;                ///< pressed on the surface at the end of the last step
  bool slipping = false;                ///< at the cone's limit in the last step
  double slip = 0.0;                    ///< distance slid over the surface since it was put on [m]
};

/// One contact point of the last step, for pictures, logs and checks.
struct ContactPoint {
  BodyIndex body_a, body_b;  ///< a < b
  Vector3 p_WC = Vector3::Zero();
  Vector3 nhat_W = Vector3::UnitZ();   ///< from a to b
  Vector3 f_W = Vector3::Zero();       ///< force on b [N]
  double phi = 0.0;                    ///< gap before the step [m], negative when they overlap
  Vector3 v_slip_W = Vector3::Zero();  ///< velocity of b along a's surface after the step [m/s]
};

/// How far the contact solver came in a step.
struct Convergence {
  bool converged = true;  ///< its sweeps ended at the tolerance and not at their largest number
  /// What is left undone where they did not: the fastest that bodies still approach at a contact
  /// point, beyond closing its gap [m/s]. Bodies sink into each other by dt times this.
  double residual = 0.0;
};

/// What one step did, for pictures, logs and checks. Forces and slip of the fingers are in the
/// state.
struct StepTrace {
  std::vector<ContactPoint> contacts;  ///< those that carry no force too
  double max_penetration = 0.0;        ///< largest overlap before the step [m], at least 0
  double kinetic_energy = 0.0;         ///< of all movables after the step [J]
  double potential_energy = 0.0;       ///< in the scene's gravity, 0 at W's origin [J]
  Convergence convergence;
};

/// Everything that the next step depends on: a copyable value. Restoring a copy, even in the middle
/// of a contact, gives the same bytes from then on.
struct WorldState {
  std::int64_t step = 0;
  double t = 0.0;
  std::vector<BodyState> bodies;                    ///< by MovableIndex; the object first
  std::array<FingertipState, kNumFingers> fingers;  ///< a plan uses thumb and index, a lift all
  /// An outer force on the object, at its centre of mass, in every step until it is set anew [N].
  Vector3 f_Ocm_W = Vector3::Zero();
  /// Impulses of the last step by (body pair, feature), to start the next one from and to keep
  /// loaded points in contact; opaque to callers.
  struct CachedImpulse {
    std::uint64_t key = 0;
    Vector3 impulse_W = Vector3::Zero();
  };
  std::vector<CachedImpulse> cache;
};

/// One row of a trace: the state after a step and the contacts of that step.
struct TraceRow {
  WorldState state;
  std::vector<ContactPoint> contacts;
};

/// Which stepper runs: World's Step or StepWithSimbody.
enum class Stepper { kKernel, kSimbody };

}  // namespace pregrasp
