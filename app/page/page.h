#pragma once

#include <filesystem>
#include <string>

#include "app/recording/loaded_run.h"

namespace pregrasp {

/// What a page may weigh [bytes]: it travels by mail.
inline constexpr std::size_t kMostPageBytes = 5'000'000;

/// A finished run as one HTML file that needs nothing else: read from top to bottom it says what
/// happened and why, with pictures; with scripts it has a slider over all steps, the contact graph
/// to be asked, and the hand's motion in three dimensions. Also of a run without success, without a
/// plan, or interrupted. What did not lead to the result is told in brief where all of it would be
/// too much. The same run gives the same bytes. @throws InputError for a page over kMostPageBytes.
std::string MakePage(const LoadedRun& run);

/// Writes it. @throws InputError likewise, or for a file that cannot be written.
void WritePage(const LoadedRun& run, const std::filesystem::path& file);

/// A style sheet, script or template of app/page/assets, by its file's name; compiled in.
const char* PageAsset(const std::string& name);

}  // namespace pregrasp
