#pragma once

#include <filesystem>

#include "app/job/run_summary.h"

namespace pregrasp {

// summary.json, from and to the struct whose fields it has.

void WriteSummary(const std::filesystem::path& file, const RunSummary& summary);
/// @throws InputError if it cannot be read or a field is missing or of another kind.
RunSummary LoadSummary(const std::filesystem::path& file);

}  // namespace pregrasp
