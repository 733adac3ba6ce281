#pragma once

#include <string>

#include "app/commands/subcommand.h"
#include "bindings/script.h"

namespace pregrasp {

/// The options that `script` and `repl` share.
struct ScriptFlags {
  ScriptConfig config;
  std::string pictures;

  void AddTo(const Subcommand& command);

  /// @param line  the command that does the same again, without these options.
  ScriptConfig Resolve(const std::string& line) const;
};

}  // namespace pregrasp
