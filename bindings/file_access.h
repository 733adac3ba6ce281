#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace pregrasp {

/// Which files a script may touch: it reads below the working directory, the script's own folder
/// and the folders the program adds (assets, its scenes); it writes below one output folder only.
/// Links are followed before the check.
class FileAccess {
 public:
  /// Starts with the working directory.
  FileAccess();

  void AllowReadsBelow(const std::filesystem::path& folder);
  /// The program's own scenes and assets, found as "scenes/.." and "assets/.." from anywhere.
  void AllowProgramFiles(const std::filesystem::path& data_folder);

  /// A relative `name` is looked for in the folders in the order they were allowed.
  /// @returns the name under which it was found, relative if it was given so and lies in the
  /// working directory.
  /// @throws InputError: missing, not a plain file, outside the folders.
  std::filesystem::path FindForReading(const std::string& name) const;

  /// The one folder that may be written below; `out` in a script's path stands for it.
  void SetOutput(const std::filesystem::path& folder) { output_ = folder; }
  const std::filesystem::path& output() const { return output_; }

  /// "out/a/b" becomes OUTPUT/a/b; a path that lies below OUTPUT already is taken as it is.
  /// @throws InputError when it lies elsewhere.
  std::filesystem::path ResolveForWriting(const std::string& name) const;

 private:
  std::vector<std::filesystem::path> readable_;  // as given
  std::filesystem::path data_folder_;            // searched last; only parts of it are readable
  std::filesystem::path output_ = "out";
};

/// The bytes of a plain file of at most `max_bytes`.
/// @throws InputError that starts with `name`.
std::string ReadPlainFile(const std::filesystem::path& name, std::size_t max_bytes);

}  // namespace pregrasp
