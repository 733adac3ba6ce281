#pragma once

#include <chrono>
#include <string>

namespace pregrasp {

/// Shows on stderr how long work comes along: on a terminal one line that changes in place, with
/// rate and time left; elsewhere one plain line a stage, and one with the same numbers every 30 s.
class ProgressLine {
 public:
  ProgressLine();
  /// Ends the line.
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// `done` of `total` pieces of `stage` are done. What is done at a stage's first call was done
  /// before, and does not count in the rate.
  void Show(const std::string& stage, int done, int total);
  /// Takes the line off a terminal, so that something else can be printed; the next Show brings it
  /// back.
  void Clear();

 private:
  bool terminal_;
  std::string stage_;
  int first_done_ = 0;  // of the stage
  std::chrono::steady_clock::time_point stage_start_, shown_;
};

}  // namespace pregrasp
