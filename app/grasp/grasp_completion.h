#pragma once

#include <vector>

#include "app/grasp/feasible_grasp.h"
#include "app/networks/grasp_generator.h"

namespace pregrasp {

struct CompletionConfig {
  GraspConfig grasp;
  /// How far a contact may be moved from where its generated point meets the surface [m].
  double max_refinement = 0.010;
  int max_refinements = 300;  ///< moved sets drawn for a sample that is not feasible as it is
  int max_solves = 16;        ///< of those, put to inverse kinematics: those whose forces hold
};

/// One generated grasp, tested.
struct CompletedGrasp {
  /// The generated points projected to the true surface; what `raw` is the test of.
  std::vector<GraspContact> projected;
  GraspResult raw;     ///< without refinement
  GraspResult result;  ///< the refined grasp if it is feasible, else `raw`
  double moved = 0.0;  ///< the farthest a contact was moved by refinement [m]
  int refinements = 0;

  bool feasible() const { return result.feasible(); }
};

/// Projects generated points to the object's surface and tests the grasp; where it is not feasible,
/// draws sets with contacts moved along the surface, farther and farther, until one is (design,
/// section 4: r_suc with refinement, r_suc_raw without). Contacts of `fixed` are kept as they are.
/// @param rng  keyed by the sample, its third index zero: the refinement draws from parts of it.
CompletedGrasp CompleteGrasp(const GraspWorld& world, const CompletionConfig& config,
                             const GraspPoints& generated, const std::vector<GraspContact>& fixed,
                             const std::vector<RigidTransform>& X_WB, const Rng& rng);

}  // namespace pregrasp
