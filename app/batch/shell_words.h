#pragma once

#include <string>
#include <vector>

namespace pregrasp {

/// A word as a POSIX shell reads it back: in single quotes unless it needs none.
std::string ShellWord(const std::string& word);

/// Words with blanks between.
std::string ShellWords(const std::vector<std::string>& words);

}  // namespace pregrasp
