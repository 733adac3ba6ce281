#include "app/job/check.h"

#include <fmt/core.h>

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/commands/check_mesh.h"
#include "app/commands/commands.h"
#include "app/core/data_folder.h"
#include "app/core/error.h"
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
  MeshCheck mesh;
  int threads = 0;
};

const char* SeverityName(CheckFinding::Severity severity) {
  constexpr const char* kNames[] = {"note", "warning", "error"};
  return kNames[static_cast<int>(severity)];
}

// Flags that make no sense of the file that was given.
void RefuseFlags(const std::vector<std::pair<const char*, bool>>& given,
                 const std::string& expected, const std::string& file) {
  for (const auto& [flag, is_given] : given) {
    if (is_given) throw InputError(flag, "", expected, file);
  }
}

int CheckMeshFile(const CheckOptions& options) {
  RefuseFlags({{"--set", !options.settings.empty()}, {"--no-grasps", options.no_grasps}},
              "a scene, a Lua file", options.scene);
  MeshCheck mesh = options.mesh;
  mesh.file = options.scene;
  return CheckMesh(mesh);
}

// One line a finding; the first error is the one line on stderr.
int Check(const CheckOptions& options) {
  if (IsMeshFile(options.scene)) return CheckMeshFile(options);
  RefuseFlags({{"--scale", options.mesh.scale != 1.0},
               {"--repair", options.mesh.repair},
               {"--picture", !options.mesh.picture.empty()}},
              "a mesh file (.obj, .stl, .ply, ..)", options.scene);
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
    ThreadPool pool(options.threads);
    const StartCertificate start = FindSceneVerdict(scene, HandOf(scene), options.seed,
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
  const Subcommand command = app.AddCommand("check",
                                            "Check a scene: overlaps, not at rest, implausible "
                                            "units, rules, graspable already; or a mesh "
                                            "file: closed or where not");
  command.Add("SCENE", options->scene, "The scene, a Lua file; or a mesh file").Required();
  command.Add("--set", options->settings, "Change a value: object.mass=0.2").OneAtATime();
  command.AddSeed(options->seed, "Of the search for grasps");
  command.AddFlag("--no-grasps", options->no_grasps,
                  "Do not ask whether the object can be grasped where it stands");
  command.Add("--scale", options->mesh.scale, "Of a mesh file: 0.001 for millimetres")
      .ShowDefault()
      .Within({1e-6, 1e6});
  command.AddFlag("--repair", options->mesh.repair,
                  "Of a mesh file: mend what repair = true in a scene would");
  command.Add("--picture", options->mesh.picture,
              "Of a mesh file: FILE.png that shows it, open edges in red");
  command.Add("--threads", options->threads, "Threads; 0 is one per processor")
      .Within(ThreadPool::kThreads)
      .ShowDefault();
  command.OnChosen([options, &action] { action = [options] { return Check(*options); }; });
}

}  // namespace pregrasp
