#include "app/training/make_item.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/core/error.h"
#include "app/geometry/point_cloud.h"
#include "app/graph/learned_scorer.h"

namespace pregrasp {
namespace {

GraspRecord MakeRecord(const GraspWorld& world, const GrownGrasp& grasp, int context,
                       const std::vector<RigidTransform>& X_WB) {
  GraspRecord record;
  record.context = context;
  record.p_OC.fill(Vector3::Zero());
  record.nhat_O.fill(Vector3::Zero());
  for (const GraspContact& contact : grasp.contacts) {
    const int f = static_cast<int>(contact.finger);
    record.used[f] = true;
    record.p_OC[f] = contact.p_OC;
    record.nhat_O[f] = contact.nhat_O;
    record.phi[f] = CalcContactDistance(world, contact.p_OC, X_WB);
  }
  return record;
}

PointCloud CloudOf(const DatasetItem& item) { return {item.P_O, item.N_O}; }

}  // namespace

std::string ItemConfig::ToJson() const {
  nlohmann::ordered_json json;
  json["version"] = 3;  // raise with any change that changes items
  json["seed"] = seed;
  json["scenes"] = scenes;
  json["points"] = points;
  json["excluded"] = nlohmann::ordered_json::object();
  for (const ExcludedObject& object : excluded) json["excluded"][object.name()] = object.hash();
  if (objects) {
    json["objects"] = nlohmann::ordered_json::object();
    for (const TrainingObject& object : *objects) {
      json["objects"][object.name] = {{"family", object.family},
                                      {"mass", object.mass},
                                      {"shape", ExcludedObject(object.name, object.shape).hash()}};
    }
  }
  return json.dump();
}

std::int64_t ItemOfFamily(const std::string& family, std::int64_t number) {
  const std::vector<std::string>& all = ObjectFamilies();
  const auto found = std::find(all.begin(), all.end(), family);
  if (found == all.end()) throw InputError("", "family", "one of ObjectFamilies()", family);
  return found - all.begin() + number * std::ssize(all);
}

SceneObject MakeItemObject(const ItemConfig& config, std::int64_t index) {
  if (config.objects) {
    return MakeSceneObject((*config.objects)[index % config.objects->size()]);
  }
  const auto& families = ObjectFamilies();
  const std::string& family = families[index % families.size()];
  constexpr int kAttempts = 200;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    TrainingObject object =
        SampleObject(family, Rng(config.seed, RngStream::kItemObject, index, attempt));
    if (!ResemblesAny(object.shape, config.excluded)) return MakeSceneObject(std::move(object));
  }
  throw InputError("", "excluded", "objects that leave room for family " + family, "none");
}

TrainingScene MakeItemScene(const ItemConfig& config, const SceneObject& object, std::int64_t index,
                            int scene) {
  return SampleTrainingScene(object, Rng(config.seed, RngStream::kItemScene, index, scene));
}

PointCloud MakeItemCloud(const ItemConfig& config, const SceneObject& object, std::int64_t index) {
  return SamplePointCloud(object.object.shape, config.points,
                          Rng(config.seed, RngStream::kItemCloud, index));
}

DatasetItem MakeEmptyItem(const SceneObject& object, const PointCloud& cloud, std::int64_t index) {
  DatasetItem item;
  item.index = index;
  item.family = object.object.family;
  item.name = object.object.name;
  item.mass = object.object.mass;
  item.p_OOcm = object.mass.p_BoBcm;
  item.P_O = cloud.P;
  item.N_O = cloud.N;
  return item;
}

ContextRecord MakeContextRecord(const GraspWorld& world, const PointCloud& cloud,
                                const std::vector<RigidTransform>& X_WB) {
  const ObjectState state = MakeObjectState(cloud, X_WB, world.environment(), world.scene().gravity,
                                            world.tips().radius(Finger::kIndex));
  ContextRecord context;
  context.X_WO = X_WB.front();
  context.phi = state.phi;
  context.occluded = state.occluded;
  return context;
}

GraspWorld MakeTrainingWorld(const Scene& scene) {
  SurfacePointsConfig surface;
  surface.spacing = 4e-3;
  surface.max_points = 3000;
  return GraspWorld(scene, HandOf(scene), surface);
}

DatasetItem MakeGraspItem(const ItemConfig& config, std::int64_t index, ThreadPool& pool) {
  const SceneObject object = MakeItemObject(config, index);
  const PointCloud cloud = MakeItemCloud(config, object, index);
  DatasetItem item = MakeEmptyItem(object, cloud, index);
  for (int s = 0; s < config.scenes; ++s) {
    const TrainingScene scene = MakeItemScene(config, object, index, s);
    const GraspWorld world = MakeTrainingWorld(scene.scene);
    Rng rng(config.seed, RngStream::kItemGrowth, index, s);
    const double moved = kReliefs[1 + rng.UniformInt(kNumReliefs - 1)];
    const bool free = scene.scene.bodies.size() == 1;
    for (const double relief : {0.0, moved}) {
      if (free && relief > 0.0) continue;
      const auto X_WB = MoveSurroundingsAway(scene.scene, cloud.P, relief);
      ContextRecord context = MakeContextRecord(world, cloud, X_WB);
      context.kind = scene.kind;
      context.scene = s;
      context.relief = relief;
      const int number = static_cast<int>(item.contexts.size());
      item.contexts.push_back(std::move(context));
      const GrowthResult grown = GrowGrasps(world, config.growth, X_WB, rng.NextU64(), pool);
      for (const GrownGrasp& grasp : grown.grasps) {
        item.grasps.push_back(MakeRecord(world, grasp, number, X_WB));
      }
    }
  }
  return item;
}

SceneLabeler::SceneLabeler(const ItemConfig& config, const DatasetItem& item,
                           const SceneObject& object, int context, const GraspGenerator& generator)
    : config_(config),
      index_(item.index),
      context_(context),
      scene_number_(item.contexts[context].scene),
      generator_(generator),
      cloud_(CloudOf(item)),
      world_(MakeTrainingWorld(MakeItemScene(config, object, item.index, scene_number_).scene)),
      X_WB_(world_.StartPoses()),
      sampler_(world_, X_WB_, {}),
      structure_(generator.BuildStructure(cloud_.P, X_WB_.front().linear())) {
  for (const GraspRecord& grasp : item.grasps) {
    if (item.contexts[grasp.context].scene == scene_number_) grasps_.push_back(&grasp);
  }
}

LabelRecord SceneLabeler::MakeLabel(int number, std::optional<LabelExample>* example) const {
  Rng rng(config_.seed, RngStream::kItemLabel, index_, scene_number_, number);
  const PlanningContacts contacts =
      SampleLabelContacts(world_, sampler_, grasps_, number % 3, config_.labels, X_WB_, rng);
  LabelRecord label =
      CalcLabel(world_, generator_, cloud_, structure_, contacts, config_.labels, rng, example);
  label.context = context_;
  return label;
}

DatasetItem AddLabels(const ItemConfig& config, DatasetItem item, const GraspGenerator& generator) {
  const SceneObject object = MakeItemObject(config, item.index);
  item.labels.clear();
  for (std::size_t c = 0; c < item.contexts.size(); ++c) {
    if (item.contexts[c].relief > 0.0) continue;
    const SceneLabeler labeler(config, item, object, static_cast<int>(c), generator);
    for (int l = 0; l < config.labels.per_scene; ++l) item.labels.push_back(labeler.MakeLabel(l));
  }
  return item;
}

}  // namespace pregrasp
