#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "app/scene/finger.h"
#include "app/scene/scene.h"

namespace pregrasp {

/// How time is stepped. The defaults are for planning; certification halves `dt` and lowers
/// `tolerance`.
struct StepConfig {
  double dt = 1.0 / 240.0;  ///< [s]
  double tolerance = 1e-5;  ///< largest change of a contact's impulse over the body's mass at which
                            ///< sweeps stop [m/s]
  double tolerance_many = 5e-6;  ///< the same for more than two movable bodies
  int max_sweeps = 20;           ///< projected Gauss-Seidel sweeps for one movable body
  int max_sweeps_many = 50;      ///< the same for more than two movable bodies
  /// Distance at which bodies at rest count as in contact [m]; what a step can cover is added, so
  /// that bodies stop at a surface and not inside it.
  double margin = 1e-4;
  /// Share of the approach speed that an impact above 0.2 m/s gives back, 0 to 1. Nothing bounces
  /// by default: a pregrasp consists of pushes.
  double restitution = 0.0;

  /// @throws InputError naming the field.
  void Validate() const;
};

/// Pose and velocity of one movable body: frame B in W; w_WB, v_WB of B's origin, expressed in W.
struct BodyState {
  Quaternion q_WB = Quaternion::Identity();
  Vector3 p_WB = Vector3::Zero();
  Vector3 w_WB = Vector3::Zero();
  Vector3 v_WB = Vector3::Zero();

  RigidTransform X_WB() const { return MakeTransform(q_WB, p_WB); }
};

/// One finger: a massless point held by a spring to a target, touching the object (body 0)
/// from outside with a friction cone. The law is the paper's f = -k (p - p_target), with damping,
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
  int body_a = 0, body_b = 0;  ///< scene indices, a < b
  Vector3 p_WC = Vector3::Zero();
  Vector3 nhat_W = Vector3::UnitZ();   ///< from a to b
  Vector3 f_W = Vector3::Zero();       ///< force on b [N]
  double phi = 0.0;                    ///< gap before the step [m], negative when they overlap
  Vector3 v_slip_W = Vector3::Zero();  ///< velocity of b along a's surface after the step [m/s]
};

/// What one step did, for pictures, logs and checks. Forces and slip of the fingers are in the
/// state.
struct StepTrace {
  std::vector<ContactPoint> contacts;  ///< those that carry no force too
  double max_penetration = 0.0;        ///< largest overlap before the step [m], at least 0
  double kinetic_energy = 0.0;         ///< of all movables after the step [J]
  double potential_energy = 0.0;       ///< in the scene's gravity, 0 at W's origin [J]
};

/// Everything that the next step depends on: a copyable value. Restoring a copy, even in the middle
/// of a contact, gives the same bytes from then on.
struct WorldState {
  std::int64_t step = 0;
  double t = 0.0;
  std::vector<BodyState> bodies;  ///< the movable bodies in scene order; the object first
  std::array<FingertipState, kNumFingers> fingers;  ///< a plan uses thumb and index, a lift all
  /// Impulses of the last step by (body pair, feature), to start the next one from and to keep
  /// loaded points in contact; opaque to callers.
  struct CachedImpulse {
    std::uint64_t key = 0;
    Vector3 impulse_W = Vector3::Zero();
  };
  std::vector<CachedImpulse> cache;
};

/// The world of one scene, built once, immutable and shared by threads: a Simbody multibody system,
/// the contact kernel generated from it, and the scene's collision shapes. All functions are const
/// and deterministic.
class World {
 public:
  /// @param scene  validated and loaded. @throws InputError for a shape that cannot be simulated.
  explicit World(const Scene& scene, const StepConfig& config = {});
  ~World();
  World(World&&) noexcept;

  const Scene& scene() const;
  const StepConfig& config() const;
  int num_movables() const;
  /// The scene's body index of movable `i`.
  int body_index(int movable) const;

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
  /// end of the step. Locks nothing, and allocates nothing once a thread's memory has grown.
  /// @param contacts  filled with the step's contact points if given.
  void Step(WorldState& state, std::vector<ContactPoint>* contacts = nullptr) const;

  /// The same step, and what it did; slower, as the energies come from Simbody.
  StepTrace StepWithTrace(WorldState& state) const;

  /// The same step computed entirely through Simbody's State and operators: the oracle for Step in
  /// tests, and the certifier of plans.
  void StepWithSimbody(WorldState& state, std::vector<ContactPoint>* contacts = nullptr) const;

  /// Kinetic plus potential energy of the movable bodies [J], by Simbody.
  double CalcEnergy(const WorldState& state) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pregrasp
