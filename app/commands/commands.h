#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace pregrasp {

/// What the command line asked for; its result is the exit code.
using Action = std::function<int()>;

// One subcommand each: describes its options to `app`, and sets `action` when it was chosen.
void AddCheck(CLI::App& app, Action& action);
void AddDataset(CLI::App& app, Action& action);
void AddInfo(CLI::App& app, Action& action);
void AddRepl(CLI::App& app, Action& action);
void AddRun(CLI::App& app, Action& action);
void AddScript(CLI::App& app, Action& action);

}  // namespace pregrasp
