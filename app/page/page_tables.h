#pragma once

#include <string>

#include "app/page/run_steps.h"
#include "app/recording/loaded_run.h"

namespace pregrasp {

// The tables of a page, as HTML. A row whose number no stage has filled in is left out, and so is a
// table without rows.

/// What the run came to: summary.json with units, in several tables.
std::string ResultTables(const RunSummary& summary);

/// What was tried: paths, screened and optimised; certificates; grasps; lifts. Those that the
/// result came from are marked.
std::string TriedTables(const LoadedRun& run, const RunSteps& steps);

/// What the run is a function of: command, seed, changed settings, program, libraries.
std::string MadeOfTables(const LoadedRun& run);

}  // namespace pregrasp
