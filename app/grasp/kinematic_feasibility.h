#pragma once

#include "app/grasp/grasp_world.h"

namespace pregrasp {

struct KinematicConfig {
  /// Restarts without collision before those with: most sets out of reach fail already there, at a
  /// fraction of the time. Not where a configuration to begin with is given.
  int reach_starts = 3;
  IkConfig ik;

  void Validate() const;
};

/// The first demand that cannot be met.
enum class KinematicStatus {
  kFeasible,
  kTipsTooClose,  ///< two fingertip spheres would overlap (TipPair)
  kTipError,      ///< the fingertips do not reach their contacts
  kCone,          ///< they do, but not with their distal axes within the cones
  kCollision,     ///< they do that too, but not without overlap
  kNotCertified,  ///< the only poses found were denied by FCL
};

struct KinematicResult {
  KinematicStatus status = KinematicStatus::kTipError;
  bool feasible() const { return status == KinematicStatus::kFeasible; }

  TipPair nearest_tips;
  bool reached = false;  ///< the hand's reach and the cones allow it, collisions aside, as tried
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
