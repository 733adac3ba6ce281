#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "app/training/make_item.h"

namespace pregrasp {

/// Which items of a data set to make, and where.
struct DatasetRun {
  std::int64_t items = 2000;  ///< of the whole data set
  int shard = 1, shards = 1;  ///< make items i with i mod shards = shard - 1
  std::filesystem::path folder;
  int threads = 0;  ///< 0: one per hardware thread. Items are spread over threads

  /// @throws InputError.
  void Validate() const;
};

struct DatasetProgress {
  std::int64_t done = 0, total = 0;  ///< items of this shard, those of earlier runs included
};

/// Makes the items that `run.folder` does not have yet. Cut off at any moment, the next call goes
/// on; the files are the same bytes whatever the shards and threads.
/// @param describe  JSON of all that decides an item, kept beside the items.
/// @throws InputError if the folder holds items of another description; Interrupted.
void MakeItems(const DatasetRun& run, const std::string& describe,
               const std::function<DatasetItem(std::int64_t index)>& make,
               const std::function<void(const DatasetProgress&)>& progress);

/// Items with grasps, described by `config`.
void MakeGraspItems(const DatasetRun& run, const ItemConfig& config,
                    const std::function<void(const DatasetProgress&)>& progress);

/// @throws InputError naming `folder` if `dataset` was not made with `config`.
void RequireDescription(const Dataset& dataset, const ItemConfig& config,
                        const std::filesystem::path& folder);

/// The items of a merged data set of grasps with labels added, described by its index and the
/// generators' file.
/// @throws InputError if `grasps` was made with another configuration.
void MakeLabelItems(const DatasetRun& run, const ItemConfig& config,
                    const std::filesystem::path& grasps, const std::filesystem::path& generator,
                    const std::function<void(const DatasetProgress&)>& progress);

}  // namespace pregrasp
