#pragma once

#include <cstdint>
#include <string>

namespace pregrasp {

/// A part of a batch: every `count`-th item, from the `number`-th.
struct Shard {
  int number = 1, count = 1;  ///< 1/1 is the whole batch

  /// @throws InputError unless it is 1/n to n/n.
  void Validate() const;
  bool Holds(std::int64_t item) const { return item % count == number - 1; }
};

/// "2/5". @throws InputError naming --shard.
Shard ParseShard(const std::string& text);

}  // namespace pregrasp
