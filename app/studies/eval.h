#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "app/batch/run_items.h"
#include "app/studies/study.h"

namespace pregrasp {

/// One run of a study, or of a shard of it, into a folder:
///   items/item-000012.json  one file an item, there when the item is done
///   items/description.json  the study, the build, scenes, seeds, settings, weights
///   records/                how each item was made (app/batch/item_record.h)
///   NAME.json, ..           the study's tables, there when all items are
struct EvalConfig {
  std::string study;
  StudySetup setup;
  Shard shard;
  std::filesystem::path out;
  bool only_count = false;  ///< make nothing: say what there is
};

/// What a line of progress says: an item that was just made, with its description, or none at the
/// start.
struct EvalProgress {
  BatchProgress batch;
  std::string made;
};

/// Makes the items of the shard that are missing; then, if all items of the study are there, its
/// tables. Cut off at any moment, the next call goes on.
/// @returns whether the tables were written.
/// @throws InputError for a scene or settings outside the project's rules, which no table may hold;
/// for a folder with items of another build, other scenes, seeds or settings, naming the
/// difference; Interrupted.
bool RunEval(const EvalConfig& config, const std::function<void(const EvalProgress&)>& progress);

/// The items of a study of which all are there, in their order.
/// @throws InputError if one is missing.
std::vector<nlohmann::json> ReadEval(const std::filesystem::path& folder);

/// Puts the items of shards together at `out`, with the tables: the same files as one run's, but
/// for seconds.
/// @throws InputError if the folders' descriptions differ, or an item is missing.
void MergeEval(const std::vector<std::filesystem::path>& folders, const std::filesystem::path& out);

}  // namespace pregrasp
