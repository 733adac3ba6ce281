#include <memory>
#include <string>
#include <vector>

#include "app/commands/commands.h"
#include "bindings/scene_file.h"

namespace pregrasp {
namespace {

struct CheckOptions {
  std::string scene;
  std::vector<std::string> settings;
};

int Check(const CheckOptions& options) {
  std::vector<Setting> settings;
  for (const std::string& setting : options.settings) settings.push_back(ParseSetting(setting));
  const Scene scene = LoadSceneFile(options.scene, settings);
  RequireNoSettingsLeft(settings);
  return 0;
}

}  // namespace

void AddCheck(CLI::App& app, Action& action) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* command = app.add_subcommand("check", "Check a scene file");
  command->add_option("SCENE", options->scene, "The scene, a Lua file")->required();
  command->add_option("--set", options->settings, "Change a value: object.mass=0.2")
      ->allow_extra_args(false);
  command->callback([options, &action] { action = [options] { return Check(*options); }; });
}

}  // namespace pregrasp
