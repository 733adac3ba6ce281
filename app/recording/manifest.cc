#include "app/recording/manifest.h"

#include <algorithm>
#include <map>

#include "app/core/check.h"
#include "app/core/error.h"
#include "app/core/file_kind.h"
#include "app/core/json_text.h"
#include "app/core/sha256.h"
#include "app/recording/checked_file.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

constexpr char kName[] = "manifest.json";
constexpr char kRunSchema[] = "pregrasp.run/1";
constexpr const char* kFinishedRun = "a finished run";
constexpr std::size_t kHexDigits = 64;

// How manifest.json lists itself, up to the digest. `files` is its last field and no other file has
// this name, so this is found from the end.
constexpr char kOwnEntry[] = "\"manifest.json\": \"";

// Of a link its target; nothing for what a run never holds, such as a pipe, which must not be read.
std::string HashOf(const fs::path& file) {
  if (fs::is_symlink(file)) return Sha256(fs::read_symlink(file).string());
  return fs::is_regular_file(file) ? Sha256OfFile(file) : "";
}

// The files that a manifest lists, with their hashes; none if it is not a run's manifest.
std::optional<std::map<std::string, std::string>> ParseManifest(const std::string& text) {
  const nlohmann::json manifest = nlohmann::json::parse(text, nullptr, false);
  if (!manifest.is_object() || manifest.value("schema", nlohmann::json()) != kRunSchema) return {};
  const auto files = manifest.find("files");
  if (files == manifest.end() || !files->is_object()) return {};
  std::map<std::string, std::string> hashes;
  for (const auto& [file, hash] : files->items()) {
    if (!hash.is_string()) return {};
    hashes[file] = hash.get<std::string>();
  }
  return hashes;
}

// Whether the text is its own digest's, the digest taken with itself blanked.
bool ProvesItself(std::string text, const std::string& hash) {
  const std::size_t entry = text.rfind(kOwnEntry + hash + '"');
  if (hash.size() != kHexDigits || entry == std::string::npos) return false;
  text.erase(entry + sizeof kOwnEntry - 1, kHexDigits);
  return Sha256(text) == hash;
}

void RequireFolder(const fs::path& directory) {
  std::error_code error;
  if (fs::is_directory(directory, error)) {
    if (fs::status_known(fs::status(directory / kName, error))) return;
    throw InputError(directory.string(), "", kFinishedRun,
                     "a folder that cannot be searched (" + error.message() + ")");
  }
  const std::string other = DescribeNonFile(directory);
  throw InputError(directory.string(), "", kFinishedRun, other.empty() ? "a file" : other);
}

// @throws InputError if the text is a whole manifest of a run, of another schema.
void RequireSchema(const std::string& text, const fs::path& directory) {
  const nlohmann::json manifest = nlohmann::json::parse(text, nullptr, false);
  if (!manifest.is_object() || manifest.value("schema", nlohmann::json()) == kRunSchema) return;
  const nlohmann::json files = manifest.value("files", nlohmann::json());
  const nlohmann::json own = files.is_object() ? files.value(kName, nlohmann::json()) : files;
  if (!own.is_string() || !ProvesItself(text, own.get<std::string>())) return;
  const nlohmann::json schema = manifest.value("schema", nlohmann::json());
  throw InputError((directory / kName).string(), "schema",
                   std::string(kRunSchema) + ", which this program can read",
                   schema.is_string() ? schema.get<std::string>() : "none");
}

}  // namespace

std::string ManifestMismatch::Sentence() const {
  switch (reason) {
    case Reason::kMissing:
      return file + " is missing";
    case Reason::kExtra:
      return file + " does not belong to the run";
    case Reason::kChanged:
      break;
  }
  return file + " was changed";
}

RunFiles ListRunFiles(const fs::path& directory) {
  RunFiles found;
  try {
    for (const auto& entry : fs::recursive_directory_iterator(directory)) {
      const bool is_folder = entry.is_directory() && !entry.is_symlink();
      (is_folder ? found.folders : found.files)
          .push_back(entry.path().lexically_relative(directory).generic_string());
    }
  } catch (const fs::filesystem_error& error) {
    throw InputError(directory.string(), "", "a folder that can be read", error.code().message());
  }
  std::sort(found.files.begin(), found.files.end());
  std::sort(found.folders.begin(), found.folders.end());
  return found;
}

void WriteManifest(const fs::path& directory, const nlohmann::ordered_json& fields) {
  nlohmann::ordered_json files = nlohmann::ordered_json::object();
  files[kName] = "";
  for (const std::string& file : ListRunFiles(directory).files) {
    if (file != kName && file != kUnfinishedMark) files[file] = HashOf(directory / file);
  }
  nlohmann::ordered_json manifest = {{"schema", kRunSchema}};
  manifest.update(fields);
  manifest["files"] = std::move(files);
  std::string text = FormatJsonIndented(manifest);
  const std::size_t entry = text.rfind(kOwnEntry);
  PREGRASP_CHECK(entry != std::string::npos);
  text.insert(entry + sizeof kOwnEntry - 1, Sha256(text));
  WriteFile(directory / kName, text);
}

bool IsFinishedRun(const fs::path& directory) {
  std::error_code error;
  if (!fs::is_regular_file(directory / kName, error)) return false;
  return ParseManifest(ReadFile(directory / kName)).has_value();
}

void RequireFinishedRun(const fs::path& directory) {
  if (IsFinishedRun(directory)) return;
  RequireFolder(directory);
  throw InputError(directory.string(), "", kFinishedRun, "a folder without a whole manifest.json");
}

std::optional<std::string> FindExtraFile(const fs::path& directory) {
  const auto hashes = ParseManifest(ReadFile(directory / kName));
  PREGRASP_CHECK(hashes.has_value(), directory);
  for (const std::string& file : ListRunFiles(directory).files) {
    if (!hashes->count(file)) return file;
  }
  return {};
}

std::optional<ManifestMismatch> VerifyManifest(const fs::path& directory) {
  using Reason = ManifestMismatch::Reason;
  RequireFolder(directory);
  std::error_code error;
  if (!fs::exists(directory / kName, error)) {
    throw InputError(directory.string(), "", kFinishedRun, "a folder without manifest.json");
  }
  const std::string text = ReadFile(directory / kName);
  RequireSchema(text, directory);
  const auto hashes = ParseManifest(text);
  if (!hashes || !hashes->count(kName) || !ProvesItself(text, hashes->at(kName))) {
    return ManifestMismatch{kName, Reason::kChanged};
  }
  const std::vector<std::string> files = ListRunFiles(directory).files;
  for (const auto& [file, hash] : *hashes) {
    if (!std::binary_search(files.begin(), files.end(), file)) {
      return ManifestMismatch{file, Reason::kMissing};
    }
  }
  for (const std::string& file : files) {
    if (!hashes->count(file)) return ManifestMismatch{file, Reason::kExtra};
  }
  for (const auto& [file, hash] : *hashes) {
    if (file != kName && HashOf(directory / file) != hash) {
      return ManifestMismatch{file, Reason::kChanged};
    }
  }
  return {};
}

}  // namespace pregrasp
