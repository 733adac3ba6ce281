#pragma once

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace pregrasp {

/// The built program at a pseudo-terminal of 100 columns, typed at and read from.
class Terminal {
 public:
  /// Whether this machine gives pseudo-terminals: some containers do not.
  static bool IsPossible() {
    int master = -1, slave = -1;
    if (openpty(&master, &slave, nullptr, nullptr, nullptr) != 0) return false;
    close(master);
    close(slave);
    return true;
  }

  Terminal(const std::vector<std::string>& arguments, const std::filesystem::path& directory) {
    winsize size{};
    size.ws_row = 40;
    size.ws_col = 100;
    std::vector<char*> argv{const_cast<char*>(PREGRASP_PROGRAM)};
    for (const std::string& argument : arguments) {
      argv.push_back(const_cast<char*>(argument.c_str()));
    }
    argv.push_back(nullptr);
    child_ = forkpty(&master_, nullptr, nullptr, &size);
    if (child_ == 0) {
      setenv("XDG_STATE_HOME", (directory / "state").c_str(), 1);
      setenv("TERM", "xterm", 1);
      setenv("LC_ALL", "C.UTF-8", 1);
      if (chdir(directory.c_str()) == 0) execv(argv[0], argv.data());
      _exit(127);
    }
  }
  ~Terminal() {
    if (child_ > 0) {
      kill(child_, SIGKILL);
      waitpid(child_, nullptr, 0);
    }
    close(master_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  void Type(const std::string& keys) {
    if (write(master_, keys.data(), keys.size()) < 0) out_ += "(gone)";
  }

  /// Reads until `text` comes; false if it does not within 20 s. What was read up to its end is
  /// then taken off.
  bool Await(const std::string& text) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    for (;;) {
      const std::size_t at = out_.find(text);
      if (at != std::string::npos) {
        seen_ = out_.substr(0, at + text.size());
        out_.erase(0, at + text.size());
        return true;
      }
      if (std::chrono::steady_clock::now() > end || !ReadSome()) return false;
    }
  }

  /// What the last Await read; what is read and not taken yet.
  const std::string& seen() const { return seen_; }
  const std::string& rest() const { return out_; }

  /// The exit code, or 128 + the signal that ended it: killed if it is silent for 20 s.
  int AwaitEnd() {
    while (ReadSome()) {
    }
    if (!gone_) kill(child_, SIGKILL);
    int status = 0;
    waitpid(child_, &status, 0);
    child_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

  void Signal(int signal) const { kill(child_, signal); }

 private:
  bool ReadSome() {
    pollfd input = {master_, POLLIN, 0};
    if (poll(&input, 1, 20000) <= 0) return false;
    char buffer[4096];
    const ssize_t count = read(master_, buffer, sizeof buffer);
    if (count > 0) out_.append(buffer, static_cast<std::size_t>(count));
    gone_ = count <= 0;
    return count > 0;
  }

  int master_ = -1;
  pid_t child_ = -1;
  bool gone_ = false;  // the other end is closed
  std::string out_, seen_;
};

}  // namespace pregrasp
