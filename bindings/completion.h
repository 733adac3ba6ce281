#pragma once

#include <string>
#include <vector>

#include "bindings/machine.h"

namespace pregrasp {

/// What may stand where a line ends so far.
struct Completion {
  std::size_t begin = 0;           ///< of the word that is completed, in the line
  std::vector<std::string> words;  ///< in its place, sorted
};

/// Completes the end of `line`, typed at the prompt of `machine`: variables, fields and methods of
/// the value before a dot or colon (no function is called to find it), and the options of a call
/// `f{ .. }`.
Completion CompleteLine(Machine& machine, const std::string& line);

}  // namespace pregrasp
