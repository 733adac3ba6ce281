#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace pregrasp {

/// A folder for one test's files, removed with it.
class TestFolder {
 public:
  explicit TestFolder(const std::filesystem::path& place = std::filesystem::temp_directory_path()) {
    std::string name = (place / "pregrasp_test_XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~TestFolder() { std::filesystem::remove_all(path_); }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;

  std::filesystem::path Write(const std::string& name, const std::string& text) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace pregrasp
