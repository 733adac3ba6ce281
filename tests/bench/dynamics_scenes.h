#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "app/core/math.h"
#include "app/scene/scene.h"

namespace pregrasp {

/// A scene, one fingertip that follows a script, and what physics says about the end.
struct DynamicsCase {
  static constexpr double kSeconds = 2.0;

  std::string name;
  Scene scene;  ///< body 1 is the table, whose top is z = 0; every body has the same friction
  bool finger = false;
  Vector3 p_OC = Vector3::Zero();
  Vector3 press = Vector3::Zero();   ///< the target's offset from the contact point after 0.3 s
  Vector3 travel = Vector3::Zero();  ///< and what is added to it until 1.5 s

  std::string quantity;  ///< what is measured at the end, with its unit
  double expected = 0.0;
  double tolerance = 0.0;
  std::function<double(const RigidTransform& X_WO)> measure;

  /// The finger's target: it presses, then travels, then rests.
  Vector3 TargetAt(double t, const Vector3& p_WC_start) const {
    return p_WC_start + std::min(1.0, t / 0.3) * press +
           std::clamp((t - 0.3) / 1.2, 0.0, 1.0) * travel;
  }
};

/// rest, pivot, slot, shelf5, push4, plate, cylinder and mesh.
std::vector<DynamicsCase> MakeDynamicsCases();

/// An engine's run of a case: its CPU time and where the object ended.
struct EngineRun {
  double cpu_seconds = 0.0;
  int steps = 0;
  RigidTransform X_WO = RigidTransform::Identity();
};

EngineRun RunPregrasp(const DynamicsCase& c);
/// Bullet's discrete world in double precision, 1/240 s, `iterations` solver iterations.
EngineRun RunBullet(const DynamicsCase& c, int iterations);
/// MuJoCo with its default solver, cone and time step of 2 ms.
EngineRun RunMujoco(const DynamicsCase& c);

/// What a batch of rollouts of a case took on `threads` threads, each with its own target.
struct BatchRun {
  double wall_seconds = 0.0;
  double cpu_seconds = 0.0;   ///< of all threads
  std::vector<Vector3> p_WO;  ///< where each rollout ended
};
BatchRun RunPregraspBatch(const DynamicsCase& c, int threads);

/// CPU time of this thread [s].
double ThreadCpuSeconds();

/// The finger for engines that have no such contact: the same spring, damper, cone and cap at a
/// fixed point of the object, as an outer force. It spares them a body and a contact.
/// @param p_WC, v_WC  the point and its velocity. @param nhat_W  outward normal there.
Vector3 CalcPeerFingerForce(const DynamicsCase& c, const Vector3& p_WTarget, const Vector3& p_WC,
                            const Vector3& v_WC, const Vector3& nhat_W);

/// Outward normal of the object's surface at the finger's point.
Vector3 FingerNormal(const DynamicsCase& c);

}  // namespace pregrasp
