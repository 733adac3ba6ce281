#include "app/batch/shard.h"

#include <charconv>

#include "app/core/error.h"

namespace pregrasp {

void Shard::Validate() const {
  if (count < 1 || number < 1 || number > count) {
    throw InputError("--shard", "", "1/n to n/n",
                     std::to_string(number) + "/" + std::to_string(count));
  }
}

Shard ParseShard(const std::string& text) {
  Shard shard;
  const char* end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, shard.number);
  const bool slash = first.ec == std::errc() && first.ptr != end && *first.ptr == '/';
  const auto second = slash ? std::from_chars(first.ptr + 1, end, shard.count) : first;
  if (!slash || second.ec != std::errc() || second.ptr != end) {
    throw InputError("--shard", "", "i/n, such as 1/2", text);
  }
  shard.Validate();
  return shard;
}

}  // namespace pregrasp
