#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace pregrasp {

/// A file of a run directory that is still being written; no manifest lists it.
inline constexpr char kUnfinishedMark[] = ".unfinished";

/// What is wrong with a file of a run directory.
struct ManifestMismatch {
  enum class Reason { kChanged, kMissing, kExtra };
  std::string file;  ///< relative to the run directory
  Reason reason = Reason::kChanged;

  /// "rollout.csv was changed", ".. is missing", ".. does not belong to the run".
  std::string Sentence() const;
};

/// What is in a run directory but folders, and the folders, each sorted by name, as paths relative
/// to it with '/'. Symbolic links are not followed. @throws InputError if it cannot be read.
struct RunFiles {
  std::vector<std::string> files, folders;
};
RunFiles ListRunFiles(const std::filesystem::path& directory);

/// Writes manifest.json: `fields`, then `files`: the SHA-256 of every file in `directory`, of a
/// symbolic link's target in its place, and of manifest.json itself with that one field empty.
/// @throws InputError as CheckedFile.
void WriteManifest(const std::filesystem::path& directory, const nlohmann::ordered_json& fields);

/// Whether `directory` holds a manifest.json of a run, which is what makes it a finished run.
/// Compares no hashes.
bool IsFinishedRun(const std::filesystem::path& directory);
/// @throws InputError unless it is one.
void RequireFinishedRun(const std::filesystem::path& directory);

/// The first file that the manifest lists and the directory lacks, that the directory has and the
/// manifest does not list, or whose bytes are not those that were written; manifest.json itself
/// comes first, then missing and extra files, then changed ones, each by name.
/// @throws InputError if there is no such directory or it has no manifest.json.
std::optional<ManifestMismatch> VerifyManifest(const std::filesystem::path& directory);

/// The first file of a finished run that its manifest does not list. Compares no hashes.
std::optional<std::string> FindExtraFile(const std::filesystem::path& directory);

}  // namespace pregrasp
