#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/job/run_summary.h"

namespace pregrasp {

/// A finished run read back: what pictures and reports of it are made from.
struct LoadedRun : FactsSource {  // NOLINT(bugprone-exception-escape): moving JSON does not throw
  std::filesystem::path directory;
  RunSummary summary;
  nlohmann::json manifest;
  Scene scene;
  std::vector<StepFacts> steps;
  std::map<std::string, int> number_of;  ///< a step's line in steps.jsonl, from 1, by id
  std::vector<Command> journal;          ///< in the order of doing

  /// @throws InputError with the nearest id.
  const StepFacts& Get(const std::string& id) const override;
};

/// The commands of journal.jsonl, in the order of doing. @throws InputError with file and line.
std::vector<Command> LoadJournal(const std::filesystem::path& directory);

/// @throws InputError if `directory` is not a finished run or a file of it cannot be read. Does not
/// compare hashes: see VerifyManifest.
LoadedRun LoadRun(const std::filesystem::path& directory);

}  // namespace pregrasp
