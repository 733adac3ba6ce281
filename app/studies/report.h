#pragma once

#include <filesystem>
#include <vector>

namespace pregrasp {

/// Writes the tables of finished studies as one Markdown document: for each folder of RunEval or
/// MergeEval what was run (seeds, paths, settings that are not the defaults, program), then its
/// table. Where the folder keeps runs (StudySetup::runs), the last step of each scene's first
/// successful run, of one without success the first run's, is drawn to PNG files in the folder
/// FILE-without-extension beside the document.
/// @throws InputError for a folder that is no finished study, or a file that cannot be written.
void WriteReport(const std::vector<std::filesystem::path>& folders,
                 const std::filesystem::path& file);

}  // namespace pregrasp
