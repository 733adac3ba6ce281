#pragma once

#include <array>

#include "app/grasp/grasp_world.h"

namespace pregrasp {

struct KinematicConfig {
  /// Between the centres of two fingertip spheres that touch their contacts [m]; nearer ones no
  /// hand can place.
  double min_tip_distance = 0.015;
  IkConfig ik;

  void Validate() const;
};

/// The first demand that cannot be met.
enum class KinematicStatus {
  kFeasible,
  kTipsTooClose,  ///< two contacts leave no room for two fingertips
  kTipError,      ///< the fingertips do not reach their contacts
  kCone,          ///< they do, but not with their distal axes within the cones
  kCollision,     ///< they do that too, but not without overlap
  kNotCertified,  ///< the only poses found were denied by FCL
};

struct KinematicResult {
  KinematicStatus status = KinematicStatus::kTipError;
  bool feasible() const { return status == KinematicStatus::kFeasible; }

  /// The two nearest fingertips, and how near their spheres' centres would be [m].
  std::array<Finger, 2> nearest_tips{};
  double tip_distance = 0.0;
  /// The hand pose, or the best attempt; left as it is built for kTipsTooClose.
  IkResult ik;
};

/// Whether one hand pose reaches all contacts, with every body at X_WB: the design's "kinematically
/// feasible". A no is not a proof: kinematics is searched by restarts (IkConfig::max_starts).
/// @param warm_start  a configuration to begin with; may be null.
KinematicResult CalcKinematicFeasibility(const GraspWorld& world, const KinematicConfig& config,
                                         const std::vector<GraspContact>& contacts,
                                         const std::vector<RigidTransform>& X_WB, Rng rng,
                                         const HandConfiguration* warm_start = nullptr);

}  // namespace pregrasp
