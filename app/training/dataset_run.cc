#include "app/training/dataset_run.h"

#include <nlohmann/json.hpp>

#include "app/core/error.h"
#include "app/core/sha256.h"

namespace pregrasp {
namespace {

constexpr const char* kProgramField = "program";

}  // namespace

void MakeItems(const DatasetRun& run, const std::string& description,
               const std::function<DatasetItem(std::int64_t)>& make,
               const std::function<void(const BatchProgress&)>& progress) {
  run.Validate();
  auto described = nlohmann::ordered_json::parse(description);
  described[kProgramField] = Sha256OfProgram();
  const ItemFolder folder(run.folder, described.dump(), kItemExtension,
                          run.only_count ? ItemFolder::Purpose::kLook : ItemFolder::Purpose::kMake);
  BatchRun batch = run;
  batch.records = run.folder / "records";
  RunItems(
      batch, folder,
      [&](std::int64_t index) {
        const DatasetItem item = make(index);
        WriteItem(folder, item);
        return item.name;
      },
      progress);
}

void MakeGraspItems(const DatasetRun& run, const ItemConfig& config,
                    const std::function<void(const BatchProgress&)>& progress) {
  MakeItems(
      run, config.ToJson(),
      [&](std::int64_t index) {
        ThreadPool alone(1);
        return MakeGraspItem(config, index, alone);
      },
      progress);
}

void MakeStateItems(const DatasetRun& run, const StateItemConfig& config,
                    const std::function<void(const BatchProgress&)>& progress) {
  MakeItems(
      run, config.ToJson(), [&](std::int64_t index) { return MakeStateItem(config, index); },
      progress);
}

void RequireDescription(const Dataset& dataset, const ItemConfig& config,
                        const std::filesystem::path& folder) {
  auto description = nlohmann::ordered_json::parse(dataset.description);
  description.erase(kProgramField);  // another build may use what one made
  if (description.dump() == config.ToJson()) return;
  throw InputError(folder.string(), "", "grasps made with this configuration",
                   "of another (" + DescribeDifference(config.ToJson(), description.dump()) + ")");
}

void MakeLabelItems(const DatasetRun& run, const ItemConfig& config,
                    const std::filesystem::path& grasps, const std::filesystem::path& generator,
                    const std::function<void(const BatchProgress&)>& progress) {
  using Json = nlohmann::ordered_json;
  const Dataset dataset = ReadDataset(grasps);
  RequireDescription(dataset, config, grasps);
  if (static_cast<std::int64_t>(dataset.items.size()) < run.items) {
    throw InputError(grasps.string(), "items", std::to_string(run.items) + " items",
                     std::to_string(dataset.items.size()));
  }
  const GraspGenerator weights = GraspGenerator::Load(generator);
  Json description = Json::parse(config.ToJson());
  description["labels_per_scene"] = config.labels.per_scene;
  description["tries"] = config.labels.tries;
  description["grasps"] = dataset.hash;
  description["generator"] = Sha256OfFile(generator);
  MakeItems(
      run, description.dump(),
      [&](std::int64_t index) { return AddLabels(config, dataset.items[index], weights); },
      progress);
}

}  // namespace pregrasp
