#include <fmt/core.h>

#include <memory>
#include <string>

#include "app/commands/commands.h"
#include "app/commands/progress.h"
#include "app/core/data_folder.h"
#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/job/facts_json.h"
#include "app/job/planner_settings.h"
#include "app/recording/build_info.h"
#include "app/recording/loaded_run.h"
#include "app/recording/manifest.h"

namespace pregrasp {
namespace {

constexpr int kBadRun = 2;

struct VerifyOptions {
  std::string run, weights;
  int threads = 0;
};

int Refuse(const std::string& run, const std::string& why) {
  fmt::print(stderr, "{}: {}\n", run, why);
  return kBadRun;
}

std::string Describe(const FactsDifference& difference, const std::string& step) {
  return fmt::format("{}: {}: the run says {}, recomputed it is {}", step, difference.field,
                     difference.left, difference.right);
}

JobSetup MakeSetup(const LoadedRun& run, const VerifyOptions& options) {
  JobSetup setup;
  setup.scene = run.scene;
  setup.seed = run.summary.seed;
  setup.weights = options.weights.empty() ? DataFolder() / "assets" / "weights"
                                          : std::filesystem::path(options.weights);
  const auto settings = run.manifest.find("settings_at_start");
  if (settings == run.manifest.end()) {
    throw InputError((run.directory / "manifest.json").string(), "settings_at_start",
                     "the settings that the run began with", "none: another version's run");
  }
  ApplySettings(*settings, setup.config);
  return setup;
}

// Applies the journal again. @returns what differs first; "" for nothing.
std::string Replay(const LoadedRun& run, const VerifyOptions& options) {
  Job job(MakeSetup(run, options), options.threads);
  Timeline timeline(job);
  if (run.journal.size() != run.steps.size()) {
    return fmt::format("journal.jsonl has {} commands for {} steps", run.journal.size(),
                       run.steps.size());
  }
  ProgressLine line;
  for (std::size_t i = 0; i < run.steps.size(); ++i) {
    ThrowIfInterrupted();
    line.Show("verifying steps", static_cast<int>(i), static_cast<int>(run.steps.size()));
    const StepFacts& told = run.steps[i];
    if (!(told.command == run.journal[i])) {
      return fmt::format("{}: command: the journal has another one", told.id);
    }
    const Timeline::Node& node = i == 0 ? timeline.root()
                                        : timeline.Do(timeline.Find(told.command.node),
                                                      told.command.verb, told.command.options);
    const auto difference = CompareFacts(told, node.facts);
    if (difference) return Describe(*difference, told.id);
  }
  return "";
}

int Verify(const VerifyOptions& options) {
  const auto mismatch = VerifyManifest(options.run);
  if (mismatch) return Refuse(options.run, mismatch->Sentence());
  const LoadedRun run = LoadRun(options.run);
  std::string difference;
  try {
    difference = Replay(run, options);
  } catch (const InputError& error) {
    difference = fmt::format("a command cannot be applied: {}", error.what());
  }
  if (!difference.empty()) {
    const std::string build = run.manifest.value("git_hash", "");
    if (build != GitHash()) difference += fmt::format(" (the run is of build {})", build);
    return Refuse(options.run, difference);
  }
  fmt::print("{}: {} steps recomputed, all facts the same\n", options.run, run.steps.size());
  return 0;
}

}  // namespace

void AddVerify(const Subcommand& app, Action& action) {
  auto options = std::make_shared<VerifyOptions>();
  const Subcommand command =
      app.AddCommand("verify", "Check a finished run's hashes, then recompute every step of it");
  command.Add("RUN_DIR", options->run, "The run directory").Required();
  command.Add("--threads", options->threads, "Threads; 0 is one per processor").ShowDefault();
  command.Add("--weights", options->weights, "Folder of the networks' weights");
  command.OnChosen([options, &action] { action = [options] { return Verify(*options); }; });
}

}  // namespace pregrasp
