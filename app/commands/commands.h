#pragma once

#include <functional>

#include "app/commands/subcommand.h"

namespace pregrasp {

/// What the command line asked for; its result is the exit code.
using Action = std::function<int()>;

// One subcommand each: describes its options to `app`, and sets `action` when it was chosen.
void AddCheck(const Subcommand& app, Action& action);
void AddDataset(const Subcommand& app, Action& action);
void AddDiff(const Subcommand& app, Action& action);
void AddEval(const Subcommand& app, Action& action);
void AddHandCommand(const Subcommand& app, Action& action);
void AddInfo(const Subcommand& app, Action& action);
void AddJobs(const Subcommand& app, Action& action);
void AddRepl(const Subcommand& app, Action& action);
void AddRun(const Subcommand& app, Action& action);
void AddScript(const Subcommand& app, Action& action);
void AddServe(const Subcommand& app, Action& action);
void AddShow(const Subcommand& app, Action& action);
void AddVerify(const Subcommand& app, Action& action);

}  // namespace pregrasp
