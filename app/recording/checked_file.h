#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace pregrasp {

/// Throws what the system's last error on a file or folder means to the user.
/// @param expected  what was expected of it.
/// @throws InputError always.
[[noreturn]] void ThrowErrno(const std::filesystem::path& path, const char* expected);

/// A file being written, with every call to the system checked. @throws InputError from each
/// function, with the system's reason ("No space left on device").
class CheckedFile {
 public:
  /// Makes the file, or empties it.
  explicit CheckedFile(std::filesystem::path file);
  /// Without Close, the file's content is undefined.
  ~CheckedFile();
  CheckedFile(const CheckedFile&) = delete;
  CheckedFile& operator=(const CheckedFile&) = delete;

  void Write(std::string_view bytes);

  /// Writes what is buffered and closes. The disk may get it later: see SyncToDisk.
  void Close();

 private:
  void Flush();

  std::filesystem::path file_;
  int descriptor_ = -1;
  std::string buffer_;
};

/// CheckedFile in one call.
void WriteFile(const std::filesystem::path& file, std::string_view bytes);

/// The whole of a file. @throws InputError if it cannot be read.
std::string ReadFile(const std::filesystem::path& file);

/// Waits until these files, and the lists of names of these folders, are on the disk. Much faster
/// than one by one: all are on their way before the first is waited for. @throws InputError.
void SyncToDisk(const std::vector<std::filesystem::path>& files_and_folders);

/// Makes a folder in one that exists, if it is not there. @throws InputError.
void MakeFolder(const std::filesystem::path& folder);

/// Makes a symbolic link. @throws InputError.
void MakeLink(const std::filesystem::path& link, const std::filesystem::path& target);

}  // namespace pregrasp
