#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace pregrasp {

/// A gzip file being written, checked as CheckedFile is (MRPT's own stream does not say when the
/// disk is full). The header carries no time and no name: same content, same bytes.
class GzipFile {
 public:
  explicit GzipFile(const std::filesystem::path& file);
  ~GzipFile();

  void Write(std::string_view bytes);
  void Close();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The content of a gzip file. @throws InputError if it cannot be read, or is cut short or damaged.
std::string ReadGzipFile(const std::filesystem::path& file);

}  // namespace pregrasp
