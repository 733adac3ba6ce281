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

#include "tests/test_folder.h"

namespace pregrasp {

struct ProgramResult {
  int code = -1;  ///< 128 + signal when one ended it
  std::string out, err;
};

inline std::string ReadText(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

/// Starts the built pregrasp in the folder `directory`; it reads `input`, and what it prints goes
/// to the files out and err in `captured`.
inline pid_t StartProgram(const std::vector<std::string>& arguments,
                          const std::filesystem::path& directory,
                          const std::filesystem::path& captured, const std::string& input = "") {
  std::filesystem::create_directories(captured);
  std::ofstream(captured / "in") << input;
  std::vector<char*> argv{const_cast<char*>(PREGRASP_PROGRAM)};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const pid_t child = fork();
  if (child != 0) return child;
  const int flags = O_WRONLY | O_CREAT | O_TRUNC;
  const bool ready = dup2(open((captured / "in").c_str(), O_RDONLY), 0) == 0 &&
                     dup2(open((captured / "out").c_str(), flags, 0600), 1) == 1 &&
                     dup2(open((captured / "err").c_str(), flags, 0600), 2) == 2 &&
                     chdir(directory.c_str()) == 0;
  if (ready) execv(argv[0], argv.data());
  _exit(127);
}

inline ProgramResult AwaitProgram(pid_t child, const std::filesystem::path& captured) {
  int status = 0;
  waitpid(child, &status, 0);
  ProgramResult result;
  result.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  result.out = ReadText(captured / "out");
  result.err = ReadText(captured / "err");
  return result;
}

/// Runs it to its end.
inline ProgramResult RunProgram(const std::vector<std::string>& arguments,
                                const std::filesystem::path& directory,
                                const std::string& input = "") {
  const TestFolder captured;
  return AwaitProgram(StartProgram(arguments, directory, captured.path(), input), captured.path());
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
