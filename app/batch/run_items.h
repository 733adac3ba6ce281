#pragma once

#include <cstdint>
#include <functional>

#include "app/batch/item_folder.h"
#include "app/batch/shard.h"

namespace pregrasp {

/// Which items of a batch to make.
struct BatchRun {
  std::int64_t items = 1;  ///< of the whole batch, from 0
  Shard shard;
  int threads = 1;  ///< items made at the same time; 0: one per hardware thread

  /// @throws InputError.
  void Validate() const;
};

struct BatchProgress {
  std::int64_t done = 0, total = 0;  ///< items of this shard, those of earlier runs included
};

/// Makes the items of the shard that `folder` does not have yet. Cut off at any moment, the next
/// call goes on.
/// @param make      makes an item and writes it to PathOf(index), whole; called by several threads.
/// @param progress  called before the first item, and after each; one call at a time.
/// @throws Interrupted between items, and what `make` throws.
void RunItems(const BatchRun& run, const ItemFolder& folder,
              const std::function<void(std::int64_t index)>& make,
              const std::function<void(const BatchProgress&)>& progress);

}  // namespace pregrasp
