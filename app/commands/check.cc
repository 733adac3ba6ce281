#include "app/job/check.h"

#include <fmt/core.h>

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "app/commands/commands.h"
#include "app/core/data_folder.h"
#include "app/core/text.h"
#include "app/core/thread_pool.h"
#include "app/job/job.h"
#include "app/job/start_verdict.h"
#include "bindings/scene_file.h"

namespace pregrasp {
namespace {

struct CheckOptions {
  std::string scene;
  std::vector<std::string> settings;
  std::uint64_t seed = 1;
  bool no_grasps = false;
};

const char* SeverityName(CheckFinding::Severity severity) {
  constexpr const char* kNames[] = {"note", "warning", "error"};
  return kNames[static_cast<int>(severity)];
}

// One line a finding; the first error is the one line on stderr.
int Check(const CheckOptions& options) {
  std::vector<Setting> settings;
  for (const std::string& setting : options.settings) settings.push_back(ParseSetting(setting));
  const Scene scene = LoadSceneFile(options.scene, settings);
  RequireNoSettingsLeft(settings);
  int errors = 0, warnings = 0;
  for (const CheckFinding& finding : CheckScene(scene)) {
    const bool error = finding.severity == CheckFinding::Severity::kError;
    errors += error;
    warnings += finding.severity == CheckFinding::Severity::kWarning;
    fmt::print(errors == 1 && error ? stderr : stdout, "{}: {}: {}\n", finding.where,
               SeverityName(finding.severity), OneLine(finding.message));
  }
  if (errors > 0) return 2;
  if (!options.no_grasps) {
    ThreadPool pool;
    const StartCertificate start = FindSceneVerdict(scene, *JobSetup().hand, options.seed,
                                                    DataFolder() / "assets" / "weights", pool);
    const bool graspable = start.verdict == StartVerdict::kGraspable;
    warnings += graspable;
    fmt::print("{}: {}{}\n", scene.object().where, graspable ? "warning: " : "",
               DescribeStart(start));
  }
  fmt::print("{}: {}, {} bodies, {}\n", options.scene,
             warnings == 0 ? "clean" : fmt::format("usable, warnings: {}", warnings),
             scene.bodies.size(), "at rest, no overlaps");
  return 0;
}

}  // namespace

void AddCheck(const Subcommand& app, Action& action) {
  auto options = std::make_shared<CheckOptions>();
  const Subcommand command = app.AddCommand(
      "check", "Check a scene: overlaps, not at rest, implausible units, rules, graspable already");
  command.Add("SCENE", options->scene, "The scene, a Lua file").Required();
  command.Add("--set", options->settings, "Change a value: object.mass=0.2").OneAtATime();
  command.AddSeed(options->seed, "Of the search for grasps");
  command.AddFlag("--no-grasps", options->no_grasps,
                  "Do not ask whether the object can be grasped where it stands");
  command.OnChosen([options, &action] { action = [options] { return Check(*options); }; });
}

}  // namespace pregrasp
