#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pregrasp {

/// The shortest text that reads back as the same double ("0.1", "1e-09", "nan"); the same on every
/// machine.
std::string FormatDouble(double value);

/// `text` fit for one line of a terminal: control characters become blanks, and what is longer than
/// 600 bytes is cut with "..".
std::string OneLine(std::string_view text);

/// The candidate that a typing error most likely meant: the nearest by edit distance (swaps count
/// as one edit), if it is nearer than half the word's length or one edit; else "". Ties go to the
/// first.
std::string FindNearest(std::string_view word, const std::vector<std::string>& candidates);

/// ` (did you mean "nearest"?)`, to be put behind a wrong word; "" where `nearest` is empty.
std::string FormatHint(std::string_view nearest);

}  // namespace pregrasp
