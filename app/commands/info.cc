#include "app/commands/commands.h"

namespace pregrasp {

void AddInfo(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("info", "Versions, OpenGL renderer, weights, processor");
  command->callback([&action] { action = [] { return 0; }; });
}

}  // namespace pregrasp
