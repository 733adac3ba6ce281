#include <memory>
#include <string>
#include <vector>

#include "app/commands/commands.h"
#include "bindings/machine.h"

namespace pregrasp {
namespace {

struct ScriptOptions {
  std::string file;
  std::vector<std::string> arguments;
  MachineConfig machine;
};

int RunScript(const ScriptOptions& options) {
  Machine machine(options.machine);
  lua_State* L = machine.state();
  machine.LoadFile(L, options.file);
  for (const std::string& argument : options.arguments) {
    luaL_checkstack(L, 2, "too many arguments");
    lua_pushlstring(L, argument.data(), argument.size());
  }
  machine.Call(static_cast<int>(options.arguments.size()), 0);
  return 0;
}

}  // namespace

void AddScript(CLI::App& app, Action& action) {
  auto options = std::make_shared<ScriptOptions>();
  CLI::App* command = app.add_subcommand("script", "Run a Lua script");
  command->add_option("FILE", options->file, "The script")->required();
  command->add_option("ARGS", options->arguments, "What the script gets as ...");
  command->add_option("--seed", options->machine.seed, "Seed of everything random")
      ->capture_default_str();
  command->add_option("--time", options->machine.seconds, "Seconds of Lua, our calls not counted")
      ->capture_default_str();
  command->callback([options, &action] { action = [options] { return RunScript(*options); }; });
}

}  // namespace pregrasp
