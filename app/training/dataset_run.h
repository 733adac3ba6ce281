#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "app/batch/run_items.h"
#include "app/training/make_item.h"
#include "app/training/state_item.h"

namespace pregrasp {

/// Which items of a data set to make, and where.
struct DatasetRun : BatchRun {
  std::filesystem::path folder;

  DatasetRun() {
    items = 2000;
    threads = 0;
  }
};

/// Makes the items that `run.folder` does not have yet (RunItems), with a record of each in its
/// folder records; the files are the same bytes
/// whatever the shards and threads.
/// @param description  JSON of all that decides an item, kept beside the items with the SHA-256 of
/// the program, any part of which may decide it, too.
/// @throws InputError if the folder holds items of another description; Interrupted.
void MakeItems(const DatasetRun& run, const std::string& description,
               const std::function<DatasetItem(std::int64_t index)>& make,
               const std::function<void(const BatchProgress&)>& progress);

/// Items with grasps, described by `config`.
void MakeGraspItems(const DatasetRun& run, const ItemConfig& config,
                    const std::function<void(const BatchProgress&)>& progress);

/// Items with states labelled by search, described by `config`.
void MakeStateItems(const DatasetRun& run, const StateItemConfig& config,
                    const std::function<void(const BatchProgress&)>& progress);

/// @throws InputError naming `folder` if `dataset` was not made with `config`, by any build.
void RequireDescription(const Dataset& dataset, const ItemConfig& config,
                        const std::filesystem::path& folder);

/// The items of a merged data set of grasps with labels added, described by its index and the
/// generators' file.
/// @throws InputError if `grasps` was made with another configuration.
void MakeLabelItems(const DatasetRun& run, const ItemConfig& config,
                    const std::filesystem::path& grasps, const std::filesystem::path& generator,
                    const std::function<void(const BatchProgress&)>& progress);

}  // namespace pregrasp
