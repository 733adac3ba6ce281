#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
#include <string_view>

namespace pregrasp::internal {

/// What separates words in the text of a mesh file.
inline constexpr std::string_view kBlank = " \t\r\n\f\v";

/// Ends the reading of a mesh file, which `what` is said of: "has a face of 2 corners".
/// @throws std::runtime_error always.
[[noreturn]] inline void Fail(const std::string& what) { throw std::runtime_error(what); }

/// Takes the next line from the beginning of `rest`, without its end; empty at the end of the text.
inline std::string_view NextLine(std::string_view& rest) {
  std::string_view line = rest.substr(0, rest.find('\n'));
  rest.remove_prefix(std::min(rest.size(), line.size() + 1));
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

/// Takes the next word from the beginning of `rest`; empty at its end.
inline std::string_view NextWord(std::string_view& rest) {
  const std::size_t begin = rest.find_first_not_of(kBlank);
  if (begin == std::string_view::npos) return {};
  const std::size_t end = std::min(rest.find_first_of(kBlank, begin), rest.size());
  const std::string_view word = rest.substr(begin, end - begin);
  rest.remove_prefix(end);
  return word;
}

}  // namespace pregrasp::internal
