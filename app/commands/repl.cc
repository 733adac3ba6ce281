#include "bindings/repl.h"

#include <memory>
#include <optional>
#include <string>

#include "app/commands/commands.h"
#include "app/commands/script_flags.h"

namespace pregrasp {
namespace {

struct ReplOptions {
  std::optional<std::string> scene;
  ScriptFlags flags;
};

int Run(const ReplOptions& options) {
  RunRepl(options.scene,
          options.flags.Resolve("pregrasp repl" + (options.scene ? " " + *options.scene : "")));
  return 0;
}

}  // namespace

void AddRepl(const Subcommand& app, Action& action) {
  auto options = std::make_shared<ReplOptions>();
  const Subcommand command = app.AddCommand("repl", "Lua at a prompt, or from a pipe");
  command.Add("SCENE", options->scene, "Opened as s");
  options->flags.AddTo(command);
  command.OnChosen([options, &action] { action = [options] { return Run(*options); }; });
}

}  // namespace pregrasp
