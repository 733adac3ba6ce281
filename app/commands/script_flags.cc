#include "app/commands/script_flags.h"

#include "app/commands/seed_option.h"

namespace pregrasp {

void ScriptFlags::AddTo(CLI::App& command) {
  AddSeedOption(command, config.machine.seed, "Seed of everything random");
  command
      .add_option("--time", config.machine.seconds, "Seconds of Lua; our own calls are not counted")
      ->capture_default_str();
  command.add_option("--out", config.output, "The folder that out/.. stands for")
      ->capture_default_str();
  command.add_option("--threads", config.threads, "Threads; 0 is one per processor")
      ->capture_default_str();
  command.add_option("--weights", config.weights, "Folder of the networks' weights");
  command.add_option("--pictures", pictures,
                     "none, key or all: overrules what the script asks for");
}

ScriptConfig ScriptFlags::Resolve(const std::string& line) const {
  ScriptConfig resolved = config;
  if (!pictures.empty()) resolved.pictures = ParsePictureMode(pictures, "--pictures", "");
  resolved.remake = line + " --seed " + std::to_string(config.machine.seed);
  return resolved;
}

}  // namespace pregrasp
