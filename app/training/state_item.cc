#include "app/training/state_item.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

namespace pregrasp {
namespace {

// Labels and grasps of one state, for its context.
void AddState(SearchLabels labels, int context, DatasetItem& item) {
  for (TruthRecord& truth : labels.truths) {
    truth.context = context;
    item.truths.push_back(std::move(truth));
  }
  for (GraspRecord& grasp : labels.grasps) {
    grasp.context = context;
    item.grasps.push_back(grasp);
  }
}

}  // namespace

StateItemConfig::StateItemConfig() {
  item.scenes = 2;
  room.sets = 96;
}

std::string StateItemConfig::ToJson() const {
  auto json = nlohmann::ordered_json::parse(item.ToJson());
  json["labels"] = "search";
  return json.dump();
}

DatasetItem MakeStateItem(const StateItemConfig& config, std::int64_t index) {
  const SceneObject object = MakeItemObject(config.item, index);
  const PointCloud cloud = MakeItemCloud(config.item, object, index);
  DatasetItem item = MakeEmptyItem(object, cloud, index);
  for (int s = 0; s < config.item.scenes; ++s) {
    const TrainingScene scene =
        SampleRestingScene(object, Rng(config.item.seed, RngStream::kItemScene, index, s, 2));
    const std::uint64_t seed = Rng(config.item.seed, RngStream::kItemScene, index, s, 1).NextU64();
    const GraspWorld grasp_world = MakeTrainingWorld(scene.scene);
    const GraspRoom room(grasp_world, config.room, seed);
    std::optional<World> world;  // with nothing to rest on, nothing moves
    if (scene.scene.bodies.size() > 1) world.emplace(scene.scene);
    std::vector<ReachedState> states(1);
    if (world) states = SampleMotionStates(*world, grasp_world, room, config.motion, seed);
    for (const ReachedState& state : states) {
      ContextRecord context = MakeContextRecord(
          grasp_world, cloud, world ? world->GetPoses(state.state) : grasp_world.StartPoses());
      context.kind =
          scene.kind + (state.moved ? " moved" : "") + (state.fixed.empty() ? "" : " held");
      context.scene = s;
      const int number = static_cast<int>(item.contexts.size());
      item.contexts.push_back(std::move(context));
      AddState(LabelState(world ? &*world : nullptr, grasp_world, room, cloud, state, config.labels,
                          Rng(seed, RngStream::kItemScene, number).NextU64()),
               number, item);
    }
  }
  return item;
}

}  // namespace pregrasp
