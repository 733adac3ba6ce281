#include "app/core/text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>

namespace pregrasp {

std::string FormatDouble(double value) {
  if (std::isnan(value)) return "nan";  // without the sign that it may have
  std::array<char, 32> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), result.ptr};
}

std::string OneLine(std::string_view text) {
  constexpr std::size_t kMaxBytes = 600;
  std::string line(text.substr(0, kMaxBytes));
  if (text.size() > kMaxBytes) {
    // Never cut within a UTF-8 character: drop its lead byte with its continuation bytes.
    while (!line.empty() && (line.back() & 0xC0) == 0x80) line.pop_back();
    if (!line.empty() && (line.back() & 0xC0) == 0xC0) line.pop_back();
    line += "..";
  }
  for (char& c : line) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = ' ';
  }
  return line;
}

namespace {

// Damerau's distance in its restricted form: insertions, deletions, substitutions, and swaps of
// neighbours.
std::size_t CalcEditDistance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substitution = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, substitution});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
      }
    }
  }
  return d[a.size()][b.size()];
}

}  // namespace

std::string FindNearest(std::string_view word, const std::vector<std::string>& candidates) {
  constexpr std::size_t kMaxWord = 64;
  std::string nearest;
  if (word.size() > kMaxWord) return nearest;
  if (word.empty()) return nearest;
  std::size_t best = std::max<std::size_t>(2, (word.size() + 1) / 2);
  for (const std::string& candidate : candidates) {
    const std::size_t distance = CalcEditDistance(word, candidate);
    if (distance < best) {
      best = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

std::string FormatHint(std::string_view nearest) {
  if (nearest.empty()) return "";
  return " (did you mean \"" + std::string(nearest) + "\"?)";
}

}  // namespace pregrasp
