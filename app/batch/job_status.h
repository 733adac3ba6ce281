#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/batch/item_record.h"
#include "app/batch/job_files.h"

namespace pregrasp {

/// What became of one item of a plan.
struct JobItem {
  std::int64_t item = 0, task = 1;
  /// "done" when its file is there; else its record's verdict, or "waiting" where it has none.
  std::string verdict;
  std::optional<ItemRecord> record;
};

/// All items, in their order. @throws InputError.
std::vector<JobItem> FindJobItems(const JobPlan& plan);

/// A table with a row an item: item, task, verdict, seconds, MB, host, log, text, command.
std::string TabulateJobItems(const std::vector<JobItem>& items);

/// A Slurm array of tasks, given as indices to which the offset is added.
struct JobArray {
  std::int64_t offset = 0;
  std::string indices;  ///< "1-3,7"
};

/// Tasks, ascending from 1, as arrays whose indices begin at `first_index` and stay below
/// `max_array` (Slurm's MaxArraySize).
std::vector<JobArray> FindJobArrays(const std::vector<std::int64_t>& tasks, int first_index,
                                    std::int64_t max_array);

}  // namespace pregrasp
