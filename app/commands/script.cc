#include "bindings/script.h"

#include <memory>
#include <string>
#include <vector>

#include "app/commands/commands.h"

namespace pregrasp {
namespace {

struct ScriptOptions {
  std::string file;
  std::vector<std::string> arguments;
  std::string pictures;
  ScriptConfig config;
};

// The command that does the same again; pictures say it in their footer.
std::string CommandLine(const ScriptOptions& options) {
  std::string line = "pregrasp script " + options.file;
  for (const std::string& argument : options.arguments) line += " " + argument;
  return line + " --seed " + std::to_string(options.config.machine.seed);
}

int Run(ScriptOptions& options) {
  if (!options.pictures.empty()) {
    options.config.pictures = ParsePictureMode(options.pictures, "--pictures", "");
  }
  options.config.remake = CommandLine(options);
  RunScript(options.file, options.arguments, options.config);
  return 0;
}

}  // namespace

void AddScript(CLI::App& app, Action& action) {
  auto options = std::make_shared<ScriptOptions>();
  CLI::App* command = app.add_subcommand("script", "Run a Lua script");
  command->add_option("FILE", options->file, "The script")->required();
  command->add_option("ARGS", options->arguments, "What the script gets as ...");
  command->add_option("--seed", options->config.machine.seed, "Seed of everything random")
      ->capture_default_str();
  command
      ->add_option("--time", options->config.machine.seconds,
                   "Seconds of Lua; our own calls are not counted")
      ->capture_default_str();
  command->add_option("--out", options->config.output, "The folder that out/.. stands for")
      ->capture_default_str();
  command->add_option("--threads", options->config.threads, "Threads; 0 is one per processor")
      ->capture_default_str();
  command->add_option("--pictures", options->pictures,
                      "none, key or all: overrules what the script asks for");
  command->callback([options, &action] { action = [options] { return Run(*options); }; });
}

}  // namespace pregrasp
