#include "app/commands/progress.h"

#include <fmt/core.h>
#include <unistd.h>

#include <cstdio>

namespace pregrasp {

ProgressLine::ProgressLine() : terminal_(isatty(STDERR_FILENO) != 0) {}

ProgressLine::~ProgressLine() { Clear(); }

void ProgressLine::Clear() {
  if (terminal_ && !stage_.empty()) fmt::print(stderr, "\r\033[K");
  std::fflush(stderr);
  stage_.clear();
}

void ProgressLine::Show(const std::string& stage, int done, int total) {
  const auto now = std::chrono::steady_clock::now();
  const bool fresh = stage != stage_;
  if (fresh) {
    stage_ = stage;
    first_done_ = done;
    stage_start_ = shown_ = now;
  }
  if (!terminal_) {
    if (fresh) fmt::print(stderr, "{}\n", stage);
    if (now - shown_ < std::chrono::seconds(30)) return;
  }
  shown_ = now;
  std::string rate;
  const double seconds = std::chrono::duration<double>(now - stage_start_).count();
  const int made = done - first_done_;
  if (made > 0 && seconds > 0.0) {
    rate =
        fmt::format(", {:.3g}/s, {:.0f} s left", made / seconds, seconds / made * (total - done));
  }
  fmt::print(stderr, "{}{} {}/{}{}{}", terminal_ ? "\r\033[K" : "", stage, done, total, rate,
             terminal_ ? "" : "\n");
  std::fflush(stderr);
}

}  // namespace pregrasp
