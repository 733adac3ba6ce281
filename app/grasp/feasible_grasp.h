#pragma once

#include <optional>
#include <vector>

#include "app/grasp/kinematic_feasibility.h"

namespace pregrasp {

struct GraspConfig {
  double f_min = 0.5;  ///< smallest normal force of every used finger [N]
  /// Ring and little may be left out where the grasp is not feasible with them.
  bool may_drop = true;
  KinematicConfig kinematics;

  void Validate() const;
};

/// The first demand that cannot be met, in the order in which they are tested: cheap ones first.
enum class GraspStatus {
  kFeasible,
  kTipsTooClose,
  kNoInternalForces,
  kWeightNotBalanced,
  kTipError,
  kCone,
  kCollision,
  kNotCertified,
};

/// "feasible", "tips_too_close", ..: the word used in logs and scripts.
const char* GraspStatusName(GraspStatus status);

struct GraspResult {
  GraspStatus status = GraspStatus::kNoInternalForces;
  bool feasible() const { return status == GraspStatus::kFeasible; }

  /// The contacts that were tested; the fingers left out are those missing from it.
  std::vector<GraspContact> contacts;
  bool uses(Finger finger) const;
  /// Forces are on the object, in its frame O. Empty when tips are too close.
  std::optional<WrenchResult> wrench;
  /// Absent when the forces failed already.
  std::optional<KinematicResult> kinematics;
};

/// One sentence for a person: which fingers, and what stands in the way. `world` is that of the
/// test.
std::string Explain(const GraspResult& result, const GraspWorld& world);

/// Tests these contacts, all of them: the design's "feasible grasp". Deterministic.
/// @param X_WB  every body's pose, the object first.
GraspResult TestContacts(const GraspWorld& world, const GraspConfig& config,
                         const std::vector<GraspContact>& contacts,
                         const std::vector<RigidTransform>& X_WB, Rng rng,
                         const HandConfiguration* warm_start = nullptr);

/// Tests a generated grasp: with all contacts, then, if allowed, without little, without ring,
/// without both. The first feasible one; else the attempt that came farthest, more fingers first.
GraspResult TestGrasp(const GraspWorld& world, const GraspConfig& config,
                      const std::vector<GraspContact>& contacts,
                      const std::vector<RigidTransform>& X_WB, Rng rng,
                      const HandConfiguration* warm_start = nullptr);

}  // namespace pregrasp
