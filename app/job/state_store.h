#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>

#include "app/job/job_state.h"

namespace pregrasp {

/// States of a timeline that are kept: the lowest number's, which the others are computed from, and
/// those used last, a bounded number of them, and of bytes. States share most of what they hold,
/// which counts once.
class StateStore {
 public:
  /// @param most_states, most_bytes  beyond either the one used longest ago goes, but not the
  ///                                 lowest number's and the newest.
  explicit StateStore(std::size_t most_states, std::size_t most_bytes)
      : most_states_(most_states), most_bytes_(most_bytes) {}

  /// Null if it is not kept. Counts as a use.
  std::shared_ptr<const JobState> Find(int number);
  /// @param number  of a node whose state is not kept.
  void Keep(int number, std::shared_ptr<const JobState> state);

  std::size_t num_states() const { return kept_.size(); }
  /// What the kept states hold, about [bytes]; the past of simulations by hand counts with the
  /// facts (facts_bytes.h).
  std::size_t bytes() const { return bytes_; }

 private:
  struct Kept {
    std::shared_ptr<const JobState> state;
    std::uint64_t used = 0;
  };
  struct Part {
    std::size_t bytes = 0;
    int states = 0;  ///< that hold it
  };

  void Drop(std::map<int, Kept>::iterator kept);

  std::size_t most_states_, most_bytes_;
  std::map<int, Kept> kept_;           // by number
  std::map<const void*, Part> parts_;  // of the kept states
  std::size_t bytes_ = 0;
  std::uint64_t uses_ = 0;
};

}  // namespace pregrasp
