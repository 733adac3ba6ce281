#pragma once

#include <functional>

#include "app/commands/command.h"

namespace pregrasp {

/// What the command line asked for; its result is the exit code.
using Action = std::function<int()>;

// One subcommand each: describes its options to `app`, and sets `action` when it was chosen.
void AddCheck(const Command& app, Action& action);
void AddDataset(const Command& app, Action& action);
void AddInfo(const Command& app, Action& action);
void AddRepl(const Command& app, Action& action);
void AddRun(const Command& app, Action& action);
void AddScript(const Command& app, Action& action);

}  // namespace pregrasp
