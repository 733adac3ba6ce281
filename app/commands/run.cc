#include <fmt/core.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/commands/commands.h"
#include "app/commands/progress.h"
#include "app/core/data_folder.h"
#include "app/core/interrupt.h"
#include "app/job/check.h"
#include "app/job/planner_settings.h"
#include "app/job/run_policy.h"
#include "bindings/scene_file.h"
#include "bindings/script.h"

namespace pregrasp {
namespace {

constexpr int kNoSuccess = 3;

struct RunOptions {
  std::string scene;
  std::uint64_t seed = 1;
  std::string out;
  RunConfig run;
  int threads = 0;
  std::vector<std::string> settings;
  std::string pictures = "key";
  std::string weights;
  bool replace = false;
};

// The command that does the same again; pictures say it in their footer.
std::string CommandLine(const RunOptions& options) {
  std::string line = fmt::format("pregrasp run {} --seed {}", options.scene, options.seed);
  if (options.run.paths != RunConfig{}.paths) line += fmt::format(" --paths {}", options.run.paths);
  if (options.run.all) line += " --all";
  for (const std::string& setting : options.settings) line += " --set " + setting;
  return line;
}

void Print(const Timeline& timeline, const RunResult& result, const std::filesystem::path& out) {
  for (const auto& node : timeline.nodes()) {
    const auto* verdict = std::get_if<VerdictFacts>(&node->facts.details);
    if (verdict != nullptr) fmt::print("{}\n", verdict->sentence);
  }
  for (const std::string& reason : result.reasons) fmt::print("{}\n", reason);
  fmt::print("{}: {}\n", out.string(), result.status);
}

int Run(const RunOptions& options) {
  options.run.Validate();
  std::vector<Setting> settings;
  for (const std::string& setting : options.settings) settings.push_back(ParseSetting(setting));
  Scene scene = LoadSceneFile(options.scene, settings);
  PlannerConfig config;
  ApplyPlannerSettings(config, settings);
  RequireNoSettingsLeft(settings, PlannerRoots());
  config.Validate();
  for (const CheckFinding& repair : ListRepairs(scene)) {
    fmt::print(stderr, "{}: note: {}\n", repair.where, repair.message);
  }
  for (const std::string& departure : RuleDepartures(scene, config)) {
    fmt::print(stderr, "{}: warning: {}\n", options.scene, departure);
  }

  SessionConfig session_config;
  session_config.seed = options.seed;
  session_config.threads = options.threads;
  session_config.command = CommandLine(options);
  session_config.planner = config;
  session_config.weights = options.weights.empty() ? DataFolder() / "assets" / "weights"
                                                   : std::filesystem::path(options.weights);
  Session session(std::move(scene), session_config);
  const std::filesystem::path out = options.out.empty()
                                        ? std::filesystem::path("out") / session.scene().name
                                        : std::filesystem::path(options.out);
  const PictureMode pictures = ParsePictureMode(options.pictures, "--pictures", "");
  // Weights that are missing or damaged are told before anything is written.
  session.job().GetPlanner(session.GetStart(), config);
  session.Record(out, pictures);
  try {
    ProgressLine line;
    const RunResult result =
        RunPlanner(session.timeline(), options.run, [&](const RunProgress& progress) {
          line.Show(progress.stage, progress.done, progress.total);
        });
    line.Show("pictures and log", 0, 1);
    session.FinishRecording(std::nullopt, result.end);
    line.Clear();
    Print(session.timeline(), result, out);
    return result.status == "ok" ? 0 : kNoSuccess;
  } catch (const Interrupted&) {
    ClearInterrupt();
    session.FinishRecording("interrupted");
    throw;
  }
}

}  // namespace

void AddRun(const Subcommand& app, Action& action) {
  auto options = std::make_shared<RunOptions>();
  const Subcommand command =
      app.AddCommand("run", "Plan: from a scene to a grasp and a hand motion");
  command.Add("SCENE", options->scene, "The scene, a Lua file").Required();
  command.AddSeed(options->seed, "Seed of everything random");
  command.Add("--out", options->out,
              "The run directory; out/NAME by default. A finished run there is replaced");
  command.Add("--paths", options->run.paths, "Paths to optimise at most")
      .Within(RunConfig::kPaths)
      .ShowDefault();
  command.AddFlag("--all", options->run.all, "Go on after the first success");
  command.Add("--threads", options->threads, "Threads; 0 is one per processor")
      .Within(ThreadPool::kThreads)
      .ShowDefault();
  command
      .Add("--set", options->settings,
           "Change a value: fingertips.friction=0.05, mppi.samples=64; info --settings lists all")
      .OneAtATime();
  command.Add("--pictures", options->pictures, "none, key or all").ShowDefault();
  command.Add("--weights", options->weights, "Folder of the networks' weights");
  command.AddFlag("--replace", options->replace,
                  "Replace a finished run at DIR (which is done anyway)");
  command.OnChosen([options, &action] { action = [options] { return Run(*options); }; });
}

}  // namespace pregrasp
