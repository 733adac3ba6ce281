#include "app/commands/script_flags.h"

namespace pregrasp {

void ScriptFlags::AddTo(const Subcommand& command) {
  command.AddSeed(config.machine.seed, "Seed of everything random");
  command.Add("--time", config.machine.seconds, "Seconds of Lua; our own calls are not counted")
      .Within({0.001, 1e6, 0, "s"})
      .ShowDefault();
  command.Add("--out", config.output, "The folder that out/.. stands for").ShowDefault();
  command.Add("--threads", config.threads, "Threads; 0 is one per processor")
      .Within(ThreadPool::kThreads)
      .ShowDefault();
  command.Add("--weights", config.weights, "Folder of the networks' weights");
  command.Add("--pictures", pictures, "none, key or all: overrules what the script asks for");
}

ScriptConfig ScriptFlags::Resolve(const std::string& line) const {
  ScriptConfig resolved = config;
  if (!pictures.empty()) resolved.pictures = ParsePictureMode(pictures, "--pictures", "");
  resolved.remake = line + " --seed " + std::to_string(config.machine.seed);
  return resolved;
}

}  // namespace pregrasp
