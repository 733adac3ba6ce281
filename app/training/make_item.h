#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/geometry/point_cloud.h"
#include "app/grasp/contact_sampler.h"
#include "app/grasp/grasp_world.h"
#include "app/networks/grasp_generator.h"
#include "app/training/dataset.h"
#include "app/training/grasp_growth.h"
#include "app/training/labels.h"
#include "app/training/object_similarity.h"
#include "app/training/training_scene.h"

namespace pregrasp {

/// Everything that decides a data set's items, but for the generators' weights.
struct ItemConfig {
  std::uint64_t seed = 1;
  int scenes = 6;    ///< of one object
  int points = 512;  ///< of its cloud
  GrowthConfig growth;
  LabelConfig labels;
  std::vector<ExcludedObject> excluded;  ///< whom no object may resemble
  /// Objects to take in turn instead of random members of ObjectFamilies(); null for these. Whether
  /// they resemble excluded ones is for whoever gives them to know (ResemblesAny).
  std::shared_ptr<const std::vector<TrainingObject>> objects;

  /// What decides an item's objects, scenes and grasps: a data set's description.
  std::string ToJson() const;
};

/// The item that is member `number` of a family: families take turns.
/// @throws InputError if there is no such family.
std::int64_t ItemOfFamily(const std::string& family, std::int64_t number);

/// The object of item `index`: families take turns; drawn again while it resembles an excluded one.
SceneObject MakeItemObject(const ItemConfig& config, std::int64_t index);

/// Scene `scene` of item `index`.
TrainingScene MakeItemScene(const ItemConfig& config, const SceneObject& object, std::int64_t index,
                            int scene);

/// The points of item `index` that the networks see.
PointCloud MakeItemCloud(const ItemConfig& config, const SceneObject& object, std::int64_t index);

/// An item with nothing found out yet.
DatasetItem MakeEmptyItem(const SceneObject& object, const PointCloud& cloud, std::int64_t index);

/// The object with all bodies at X_WB, as the networks see it.
ContextRecord MakeContextRecord(const GraspWorld& world, const PointCloud& cloud,
                                const std::vector<RigidTransform>& X_WB);

/// What tests of grasps in a training scene share; its surface points are coarser than the
/// planner's, which only the drawing of contacts sees.
GraspWorld MakeTrainingWorld(const Scene& scene);

/// Item `index` with feasible grasps: in every scene as it is, and with the surroundings moved away
/// by one relief drawn at random.
DatasetItem MakeGraspItem(const ItemConfig& config, std::int64_t index, ThreadPool& pool);

/// Makes the labels of one scene of an item, each a pure function of (configuration, item, scene,
/// number).
class SceneLabeler {
 public:
  /// @param context  of the item: the scene as it is, relief 0. All references outlive this.
  SceneLabeler(const ItemConfig& config, const DatasetItem& item, const SceneObject& object,
               int context, const GraspGenerator& generator);

  /// Label `number` >= 0 of the scene. @param example  as CalcLabel's.
  LabelRecord MakeLabel(int number, std::optional<LabelExample>* example = nullptr) const;

  const GraspWorld& world() const { return world_; }
  const PointCloud& cloud() const { return cloud_; }

 private:
  const ItemConfig& config_;
  std::int64_t index_;
  int context_, scene_number_;
  const GraspGenerator& generator_;
  PointCloud cloud_;
  GraspWorld world_;
  std::vector<RigidTransform> X_WB_;
  ContactSampler sampler_;
  CloudStructure structure_;
  std::vector<const GraspRecord*> grasps_;
};

/// The item with labels added, in its scenes as they are.
/// @param item  from MakeGraspItem with the same configuration.
DatasetItem AddLabels(const ItemConfig& config, DatasetItem item, const GraspGenerator& generator);

}  // namespace pregrasp
