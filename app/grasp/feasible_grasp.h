#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/grasp/kinematic_feasibility.h"
#include "app/grasp/min_norm_point.h"

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
  kNoPlace,  ///< thumb, index or middle finger can be nowhere on the object
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

/// A part of the hand and what it would overlap, by name.
struct HandOverlap {
  std::string link;   ///< of the hand
  std::string other;  ///< a body of the scene, or another link
  /// [m]; not above what is allowed where the best attempt keeps clear and misses a contact
  /// instead.
  double depth = 0.0;
};

/// What stands in the way of a grasp, as data for pictures and scripts. Which field is set goes
/// with the status.
struct GraspFault {
  /// kTipsTooClose: the pair that overlaps the most.
  std::optional<TipPair> tips;
  /// kNoInternalForces, kWeightNotBalanced: the unit wrench on the object that admissible forces
  /// cannot give, whichever they are: force, then torque about the centre of mass over
  /// GraspWorld::object_radius, along O's axes.
  std::optional<Vector6> missing_wrench;
  /// kCollision, kNotCertified.
  std::optional<HandOverlap> overlap;
  /// kNoPlace: that finger. kTipError, kCone: the finger that misses its contact the most, or leans
  /// over it the most.
  std::optional<Finger> finger;
};

struct GraspResult {
  GraspStatus status = GraspStatus::kNoInternalForces;
  bool feasible() const { return status == GraspStatus::kFeasible; }

  /// The contacts that were tested; the fingers left out are those missing from it.
  std::vector<GraspContact> contacts;
  bool uses(Finger finger) const;
  /// Forces are on the object, in its frame O. Absent when tips are too close.
  std::optional<WrenchResult> wrench;
  /// Absent when the forces failed already.
  std::optional<KinematicResult> kinematics;
  GraspFault fault;  ///< nothing if feasible
};

/// One sentence for a person: which fingers, and what stands in the way.
std::string Explain(const GraspResult& result);

/// How far contacts come, without the forces and reasons that only a report needs.
struct GraspAttempt {
  std::vector<GraspContact> contacts;
  GraspStatus status = GraspStatus::kTipsTooClose;
  std::optional<KinematicResult> kinematics;  ///< absent when the forces failed already
  bool feasible() const { return status == GraspStatus::kFeasible; }
};

/// Whether the spheres of all tips are apart and forces hold. No contacts hold nothing.
/// @param missing  may be null; set as CalcWrenchStatus sets it where forces are missing.
GraspStatus CalcForceStatus(const GraspWorld& world, const GraspConfig& config,
                            const std::vector<GraspContact>& contacts, const Matrix3& R_WO,
                            Vector6* missing = nullptr);

/// Tests these contacts, all of them: the design's "feasible grasp". Deterministic.
GraspAttempt TryContacts(const GraspWorld& world, const GraspConfig& config,
                         const std::vector<GraspContact>& contacts,
                         const std::vector<RigidTransform>& X_WB, Rng rng,
                         const HandConfiguration* warm_start = nullptr);

/// An attempt with everything there is to say about it.
GraspResult ReportGrasp(const GraspWorld& world, const GraspConfig& config,
                        const GraspAttempt& attempt, const std::vector<RigidTransform>& X_WB);

/// Tests these contacts, all of them: the design's "feasible grasp". Deterministic.
/// @param X_WB  every body's pose, the object first.
GraspResult TestContacts(const GraspWorld& world, const GraspConfig& config,
                         const std::vector<GraspContact>& contacts,
                         const std::vector<RigidTransform>& X_WB, Rng rng,
                         const HandConfiguration* warm_start = nullptr);

/// Whether a grasp may be without the finger: ring and little.
bool IsDroppable(Finger finger);
/// What may be left out of a generated grasp, in the order in which that is tried: nothing, little,
/// ring, both.
std::vector<std::vector<Finger>> DroppableSets(const TipSpheres& tips, bool may_drop);
std::vector<GraspContact> WithoutFingers(const std::vector<GraspContact>& contacts,
                                         const std::vector<Finger>& fingers);

/// Tests a generated grasp: with all contacts, then, if allowed, without those of DroppableSets.
/// The first feasible one; else the attempt that came farthest, more fingers first. Thumb, index
/// and middle finger have to be among the contacts: else kNoPlace.
GraspAttempt TryGrasp(const GraspWorld& world, const GraspConfig& config,
                      const std::vector<GraspContact>& contacts,
                      const std::vector<RigidTransform>& X_WB, Rng rng,
                      const HandConfiguration* warm_start = nullptr);

/// The report of the same.
GraspResult TestGrasp(const GraspWorld& world, const GraspConfig& config,
                      const std::vector<GraspContact>& contacts,
                      const std::vector<RigidTransform>& X_WB, Rng rng,
                      const HandConfiguration* warm_start = nullptr);

}  // namespace pregrasp
