#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "bindings/script.h"

namespace pregrasp {

/// The options that `script` and `repl` share.
struct ScriptFlags {
  ScriptConfig config;
  std::string pictures;

  void AddTo(CLI::App& command);

  /// @param line  the command that does the same again, without these options.
  ScriptConfig Resolve(const std::string& line) const;
};

}  // namespace pregrasp
