#include "app/core/text.h"

#include <array>
#include <charconv>

namespace pregrasp {

std::string FormatDouble(double value) {
  std::array<char, 32> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), result.ptr};
}

}  // namespace pregrasp
