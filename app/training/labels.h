#pragma once

#include <optional>
#include <vector>

#include "app/geometry/point_cloud.h"
#include "app/grasp/contact_sampler.h"
#include "app/grasp/grasp_completion.h"
#include "app/networks/grasp_generator.h"
#include "app/training/dataset.h"

namespace pregrasp {

/// How labels of the score function are made: contacts are drawn, the grasp generators complete
/// them, and the share of feasible completions is taken at each relief (kReliefs).
struct LabelConfig {
  int per_scene = 12;  ///< labels in one scene; a third each of thumb, index and both
  int tries = 4;       ///< completions at each relief, 20 in all
  /// Where the given contacts come from: feasible grasps of the scene, moved by up to 5 mm; any
  /// points of the surface; otherwise plausible sets, where fingertips can be.
  double from_grasps = 0.35;
  double anywhere = 0.20;
  /// With fewer refinements and restarts than the planner's: labels are many.
  CompletionConfig completion;

  LabelConfig();
};

/// Contacts for one label: thumb, index or both (GeneratorOf's order) on the object with every body
/// at X_WB. @param grasps  of this scene; may be empty.
PlanningContacts SampleLabelContacts(const GraspWorld& world, const ContactSampler& sampler,
                                     const std::vector<const GraspRecord*>& grasps, int which,
                                     const LabelConfig& config,
                                     const std::vector<RigidTransform>& X_WB, Rng& rng);

/// A feasible completion behind a label, for pictures.
struct LabelExample {
  double relief = 0.0;  ///< how far the surroundings are moved away [m]
  std::vector<GraspContact> contacts;
  HandConfiguration hand;
};

/// What the label of `contacts` is made of. The surroundings are moved away by each relief, from
/// the largest down; after two reliefs in a row without any feasible completion the smaller ones
/// count as without.
/// @param cloud  the points that the generators see; `structure` is theirs.
/// @param rng      of stream kDataset, keyed by the label.
/// @param example  set to a completion at the least relief that has one, if given.
LabelRecord CalcLabel(const GraspWorld& world, const GraspGenerator& generator,
                      const PointCloud& cloud, const CloudStructure& structure,
                      const PlanningContacts& contacts, const LabelConfig& config, const Rng& rng,
                      std::optional<LabelExample>* example = nullptr);

/// The signed distance from a point of the object to the surroundings [m]; infinity without.
double CalcContactDistance(const GraspWorld& world, const Vector3& p_OC,
                           const std::vector<RigidTransform>& X_WB);

}  // namespace pregrasp
