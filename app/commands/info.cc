#include <fmt/core.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "app/commands/commands.h"
#include "app/core/data_folder.h"
#include "app/job/planner_settings.h"
#include "app/recording/build_info.h"
#include "bindings/machine.h"
#include "bindings/planner_options.h"
#include "bindings/scene_file.h"
#include "render/renderer.h"

namespace pregrasp {
namespace {

void Line(const std::string& name, const std::string& value) {
  fmt::print("{:<10} {}\n", name, value);
}

// The value of `key` in /proc/cpuinfo, of the first processor.
std::string FindInCpuInfo(const std::string& key) {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    if (line.rfind(key, 0) != 0) continue;
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

std::string Weights() {
  namespace fs = std::filesystem;
  std::map<std::string, std::uintmax_t> files;
  const fs::path folder = DataFolder() / "assets" / "weights";
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    if (entry.is_regular_file()) files[entry.path().filename().string()] = entry.file_size();
  }
  if (files.empty()) return "none in " + folder.string();
  std::string text;
  for (const auto& [name, bytes] : files) {
    text += fmt::format("{}{} ({} kB)", text.empty() ? "" : ", ", name, bytes / 1000);
  }
  return text;
}

// The whole table of a planner's settings, a line each.
int PrintSettings() {
  fmt::print("{:<25} {:<8} {:<18} {}\n", "--set", "default", "values", "meaning");
  for (const PlannerSetting& setting : SettingsTable()) {
    const std::string rule = setting.rule.Text();
    fmt::print("{:<25} {:<8} {:<18} {}{}\n", setting.name, FieldText(setting.Default()),
               setting.Values(), setting.meaning, rule.empty() ? "" : "; within the rules " + rule);
  }
  return 0;
}

int Info() {
  Line("pregrasp", fmt::format("{}, commit {}", ProgramVersion(), GitHash()));
  Line("data", DataFolder().string());
  std::map<std::string, std::string> libraries = BuildLibraries();
  libraries["lua"] = LUA_VERSION_MAJOR "." LUA_VERSION_MINOR "." LUA_VERSION_RELEASE;
  std::string list;
  for (const auto& [name, version] : libraries) {
    list += fmt::format("{}{} {}", list.empty() ? "" : ", ", name, version);
  }
  Line("libraries", list);
  Line("opengl", Renderer().description());
  Line("weights", Weights());
  Line("processor", fmt::format("{}, {} threads, {}", FindInCpuInfo("model name"),
                                std::thread::hardware_concurrency(), ProcessorFeatures()));
  return 0;
}

}  // namespace

void AddInfo(const Subcommand& app, Action& action) {
  auto settings = std::make_shared<bool>(false), annotations = std::make_shared<bool>(false);
  const Subcommand command =
      app.AddCommand("info", "Versions, OpenGL renderer, weights, processor");
  command.AddFlag("--settings", *settings,
                  "Instead: every setting that --set takes beside the scene's, with its default");
  command.AddFlag(
      "--annotations", *annotations,
      "Instead: the options of the planner's stages in Lua, as annotations for editors");
  command.OnChosen([settings, annotations, &action] {
    action = [settings, annotations] {
      if (*annotations) {
        fmt::print("{}", OptionAnnotations());
        return 0;
      }
      return *settings ? PrintSettings() : Info();
    };
  });
}

}  // namespace pregrasp
