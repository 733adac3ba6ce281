#include <fmt/core.h>

#include <memory>
#include <string>

#include "app/commands/commands.h"
#include "app/commands/progress.h"
#include "app/core/data_folder.h"
#include "app/recording/manifest.h"
#include "app/session/verification.h"

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

std::string Tell(const RunDifference& difference) {
  return difference.Sentence("the run says", "recomputed it is");
}

// Of a run of another build: what differs, and whether the planner decided alike.
int ReportOtherBuild(const std::string& run, const Verification& verification) {
  const RunComparison& comparison = verification.comparison;
  std::string text =
      fmt::format("{}: made by another build ({}): ", run, verification.provenance.build);
  text += comparison.decision() ? "not every decision is the same"
                                : fmt::format("{} steps recomputed, every decision{} is the same",
                                              verification.num_steps,
                                              comparison.largest() ? "" : " and every number");
  if (comparison.largest()) {
    text += fmt::format("; the largest difference is {:.2g}, {}",
                        *comparison.largest()->value.distance, Tell(*comparison.largest()));
  }
  if (comparison.first()) {
    text += fmt::format("; the first beyond {:g} is {}", kOtherBuildTolerance,
                        Tell(*comparison.first()));
  }
  if (comparison.decision()) {
    text += fmt::format("; the first decision that differs is {}", Tell(*comparison.decision()));
  }
  fmt::print(comparison.first() ? stderr : stdout, "{}\n", text);
  return comparison.first() ? kBadRun : 0;
}

int Verify(const VerifyOptions& options) {
  const auto mismatch = VerifyManifest(options.run);
  if (mismatch) return Refuse(options.run, mismatch->Sentence());
  VerifyConfig config;
  config.threads = options.threads;
  config.weights = options.weights.empty() ? DataFolder() / "assets" / "weights"
                                           : std::filesystem::path(options.weights);
  Verification verification;
  {
    ProgressLine line;
    config.progress = [&](int done, int total) { line.Show("verifying steps", done, total); };
    verification = VerifyRun(options.run, config);
  }
  if (!verification.provenance.same_build) return ReportOtherBuild(options.run, verification);
  if (verification.comparison.first()) {
    return Refuse(options.run, Tell(*verification.comparison.first()));
  }
  fmt::print("{}: {} steps recomputed, every file the same\n", options.run, verification.num_steps);
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
