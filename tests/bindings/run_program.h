#pragma once

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace pregrasp {

struct ProgramResult {
  int code = -1;
  std::string out, err;
};

inline std::string ReadText(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

/// Runs the built pregrasp with `arguments` in the folder `directory`. What it prints is caught in
/// files outside of that folder.
inline ProgramResult RunProgram(const std::vector<std::string>& arguments,
                                const std::filesystem::path& directory) {
  std::string captured =
      (std::filesystem::temp_directory_path() / "pregrasp_output_XXXXXX").string();
  const std::filesystem::path folder = mkdtemp(captured.data());
  const pid_t child = fork();
  if (child == 0) {
    std::vector<char*> argv{const_cast<char*>(PREGRASP_PROGRAM)};
    for (const std::string& argument : arguments)
      argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    const int flags = O_WRONLY | O_CREAT | O_TRUNC;
    const bool ready = chdir(directory.c_str()) == 0 &&
                       dup2(open((folder / "out").c_str(), flags, 0600), 1) == 1 &&
                       dup2(open((folder / "err").c_str(), flags, 0600), 2) == 2;
    if (ready) execv(argv[0], argv.data());
    _exit(127);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ProgramResult result;
  result.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  result.out = ReadText(folder / "out");
  result.err = ReadText(folder / "err");
  std::filesystem::remove_all(folder);
  return result;
}

/// Every file below a folder, with its size: what a run must not change.
inline std::vector<std::string> ListFiles(const std::filesystem::path& folder) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const bool plain = std::filesystem::is_regular_file(entry.symlink_status());
    const auto size = plain ? entry.file_size() : 0;
    files.push_back(entry.path().lexically_relative(folder).string() + " " + std::to_string(size));
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace pregrasp
