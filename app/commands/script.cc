#include "bindings/script.h"

#include <memory>
#include <string>
#include <vector>

#include "app/commands/commands.h"
#include "app/commands/script_flags.h"

namespace pregrasp {
namespace {

struct ScriptOptions {
  std::string file;
  std::vector<std::string> arguments;
  ScriptFlags flags;
};

int Run(const ScriptOptions& options) {
  std::string line = "pregrasp script " + options.file;
  for (const std::string& argument : options.arguments) line += " " + argument;
  RunScript(options.file, options.arguments, options.flags.Resolve(line));
  return 0;
}

}  // namespace

void AddScript(const Subcommand& app, Action& action) {
  auto options = std::make_shared<ScriptOptions>();
  const Subcommand command = app.AddCommand("script", "Run a Lua script");
  command.Add("FILE", options->file, "The script").Required();
  command.Add("ARGS", options->arguments, "What the script gets as ...");
  options->flags.AddTo(command);
  command.OnChosen([options, &action] { action = [options] { return Run(*options); }; });
}

}  // namespace pregrasp
