#include "app/commands/progress.h"

#include <fmt/core.h>
#include <unistd.h>

#include <cstdio>

namespace pregrasp {

ProgressLine::ProgressLine() : terminal_(isatty(STDERR_FILENO) != 0) {}

ProgressLine::~ProgressLine() {
  if (terminal_ && !stage_.empty()) fmt::print(stderr, "\r\033[K");
}

void ProgressLine::Show(const std::string& stage, int done, int total) {
  const auto now = std::chrono::steady_clock::now();
  const bool fresh = stage != stage_;
  if (fresh) {
    stage_ = stage;
    stage_start_ = now;
  }
  if (!terminal_) {
    if (fresh) fmt::print(stderr, "{}\n", stage);
    return;
  }
  std::string rate;
  const double seconds = std::chrono::duration<double>(now - stage_start_).count();
  if (done > 0 && seconds > 0.0) {
    rate =
        fmt::format(", {:.1f}/s, {:.0f} s left", done / seconds, seconds / done * (total - done));
  }
  fmt::print(stderr, "\r\033[K{} {}/{}{}", stage, done, total, rate);
  std::fflush(stderr);
}

}  // namespace pregrasp
