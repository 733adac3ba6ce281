#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "app/batch/item_folder.h"
#include "app/batch/shard.h"

namespace pregrasp {

/// Which items of a batch to make.
struct BatchRun {
  std::int64_t items = 1;  ///< of the whole batch, from 0
  Shard shard;
  int threads = 1;                ///< items made at the same time; 0: one per hardware thread
  std::filesystem::path records;  ///< folder for a record of each item's making; empty: none
  bool only_count = false;        ///< make nothing: say what there is

  /// @throws InputError.
  void Validate() const;
};

struct BatchProgress {
  std::int64_t done = 0, total = 0;  ///< items of this shard, those of earlier runs included
  std::int64_t items = 0;            ///< of the whole batch
};

/// "out/x: 40 items, 5 in this shard, 3 of them made".
std::string DescribeCounts(const std::string& folder, const BatchProgress& counts);
/// The number of items that a text which ends so says; none for another text.
std::optional<std::int64_t> ParseItemCount(const std::string& text);

/// Makes the items of the shard that `folder` does not have yet. Cut off at any moment, the next
/// call goes on.
/// @param make      makes an item and writes it to PathOf(index), whole; called by several threads.
///                  Returns a line about it for its record.
/// @param progress  called before the first item, and after each; one call at a time.
/// @throws Interrupted between items, and what `make` throws: at once, but for InternalError, our
/// bug in one item, which takes the others with it no more than a crash of another task would.
void RunItems(const BatchRun& run, const ItemFolder& folder,
              const std::function<std::string(std::int64_t index)>& make,
              const std::function<void(const BatchProgress&)>& progress);

}  // namespace pregrasp
