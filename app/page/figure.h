#pragma once

#include <filesystem>
#include <string>

#include "app/recording/loaded_run.h"

namespace pregrasp {

/// Drawings of a run's page as SVG documents of their own, dark on white, for print: "costs", of
/// the iterations along each path that was optimised; "graph", of the contact states that are kept.
/// @throws InputError for another name, or a run that has nothing of the kind.
std::string MakeFigure(const LoadedRun& run, const std::string& what);

/// Writes it. @throws InputError likewise, or for a file that cannot be written.
void WriteFigure(const LoadedRun& run, const std::string& what, const std::filesystem::path& file);

}  // namespace pregrasp
