#include "bindings/file_access.h"

#include <algorithm>
#include <fstream>
#include <system_error>

#include "app/core/error.h"
#include "app/core/file_kind.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

bool IsBelow(const fs::path& path, const fs::path& folder) {
  std::error_code error;
  const fs::path real_path = fs::weakly_canonical(fs::absolute(path, error), error);
  if (error) return false;  // such as a loop of links
  const fs::path real_folder = fs::weakly_canonical(fs::absolute(folder, error), error);
  if (error) return false;
  const auto [rest, end] =
      std::mismatch(real_folder.begin(), real_folder.end(), real_path.begin(), real_path.end());
  return rest == real_folder.end() || (rest->empty() && std::next(rest) == real_folder.end());
}

void RequirePlainFile(const fs::path& file, const std::string& name) {
  const std::string other = DescribeNonFile(file);
  if (!other.empty()) throw InputError(name, "", "a file", other);
}

}  // namespace

FileAccess::FileAccess() { AllowReadsBelow("."); }

void FileAccess::AllowReadsBelow(const fs::path& folder) {
  readable_.push_back(folder.empty() ? fs::path(".") : folder);
}

void FileAccess::AllowProgramFiles(const fs::path& data_folder) { data_folder_ = data_folder; }

fs::path FileAccess::FindForReading(const std::string& name) const {
  if (name.find('\0') != std::string::npos)
    throw InputError("", "", "a file's name", "a zero byte");
  fs::path found = name;
  if (found.is_relative()) {
    std::vector<fs::path> folders = readable_;
    if (!data_folder_.empty()) folders.push_back(data_folder_);
    for (const fs::path& folder : folders) {
      const fs::path candidate = folder == "." ? fs::path(name) : folder / name;
      std::error_code ignored;
      if (fs::exists(candidate, ignored)) {
        found = candidate;
        break;
      }
    }
  }
  RequirePlainFile(found, name);
  std::vector<fs::path> allowed = readable_;
  if (!data_folder_.empty()) {
    for (const char* part : {"assets", "scenes"}) allowed.push_back(data_folder_ / part);
  }
  if (std::none_of(allowed.begin(), allowed.end(),
                   [&](const fs::path& folder) { return IsBelow(found, folder); })) {
    throw InputError(name, "", "a file in the working directory, the script's folder or the assets",
                     "one elsewhere");
  }
  return found;
}

fs::path FileAccess::ResolveForWriting(const std::string& name) const {
  const fs::path path = name;
  const fs::path normal = path.lexically_normal();  // so that out/../.. is not taken for ours
  fs::path resolved = path;
  if (normal.is_relative() && normal.begin() != normal.end() && *normal.begin() == "out") {
    resolved = (output_ / normal.lexically_relative("out")).lexically_normal();
  }
  if (name.find('\0') != std::string::npos || !IsBelow(resolved, output_)) {
    throw InputError(name, "", "a path in the output folder (\"out/..\")", "one elsewhere");
  }
  return resolved;
}

std::string ReadPlainFile(const fs::path& name, std::size_t max_bytes) {
  RequirePlainFile(name, name.string());
  std::ifstream in(name, std::ios::binary);
  if (!in) throw InputError(name.string(), "", "a file that can be read", "one that cannot");
  std::error_code error;
  const auto size = fs::file_size(name, error);
  if (error || size > max_bytes) {
    throw InputError(name.string(), "", "a file of at most " + std::to_string(max_bytes) + " bytes",
                     std::to_string(size));
  }
  std::string bytes(size, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(size));
  if (in.gcount() != static_cast<std::streamsize>(size)) {
    throw InputError(name.string(), "", "a file that can be read", "a read error");
  }
  return bytes;
}

}  // namespace pregrasp
