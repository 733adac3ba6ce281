#include "app/training/dataset_run.h"

#include <mutex>
#include <nlohmann/json.hpp>
#include <vector>

#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/core/sha256.h"

namespace pregrasp {

void DatasetRun::Validate() const {
  if (items < 1) throw InputError("", "items", "at least 1", std::to_string(items));
  if (shards < 1 || shard < 1 || shard > shards) {
    throw InputError("", "shard", "1/n to n/n",
                     std::to_string(shard) + "/" + std::to_string(shards));
  }
}

void MakeItems(const DatasetRun& run, const std::string& describe,
               const std::function<DatasetItem(std::int64_t)>& make,
               const std::function<void(const DatasetProgress&)>& progress) {
  run.Validate();
  const DatasetFolder folder(run.folder, describe);
  DatasetProgress state;
  std::vector<std::int64_t> missing;
  for (std::int64_t i = run.shard - 1; i < run.items; i += run.shards) {
    ++state.total;
    if (folder.Has(i)) {
      ++state.done;
    } else {
      missing.push_back(i);
    }
  }
  if (progress) progress(state);
  ThreadPool pool(run.threads);
  std::mutex mutex;
  pool.ParallelFor(static_cast<int>(missing.size()), [&](int k, int) {
    ThrowIfInterrupted();
    folder.Write(make(missing[k]));
    const std::lock_guard lock(mutex);
    ++state.done;
    if (progress) progress(state);
  });
}

void MakeGraspItems(const DatasetRun& run, const ItemConfig& config,
                    const std::function<void(const DatasetProgress&)>& progress) {
  MakeItems(
      run, config.ToJson(),
      [&](std::int64_t index) {
        ThreadPool alone(1);
        return MakeGraspItem(config, index, alone);
      },
      progress);
}

void RequireDescription(const Dataset& dataset, const ItemConfig& config,
                        const std::filesystem::path& folder) {
  if (dataset.description != config.ToJson()) {
    throw InputError(folder.string(), "", "grasps made with this configuration",
                     dataset.description);
  }
}

void MakeLabelItems(const DatasetRun& run, const ItemConfig& config,
                    const std::filesystem::path& grasps, const std::filesystem::path& generator,
                    const std::function<void(const DatasetProgress&)>& progress) {
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
