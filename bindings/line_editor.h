#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "bindings/completion.h"

namespace pregrasp {

/// Lines from the terminal, edited by libedit: history over sessions, completion by Tab.
class LineEditor {
 public:
  using Completer = std::function<Completion(const std::string& line)>;

  /// @param history  the file that holds it; empty for none. A file that cannot be written is no
  ///                 error.
  LineEditor(const std::filesystem::path& history, Completer completer);
  ~LineEditor();

  /// The next line, without its end; none at the end of the input.
  /// @throws Interrupted for Ctrl-C, with what was typed dropped.
  std::optional<std::string> Read(const std::string& prompt);

  /// [characters]
  int width() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Where the history of prompts is kept: below $XDG_STATE_HOME, else ~/.local/state; empty if there
/// is no home.
std::filesystem::path HistoryFile();

}  // namespace pregrasp
