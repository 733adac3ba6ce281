#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "app/recording/run_comparison.h"

namespace pregrasp {

/// How a finished run is recomputed.
struct VerifyConfig {
  int threads = 0;                ///< 0: one per hardware thread; cannot change a result
  std::filesystem::path weights;  ///< the folder of the networks' weights
  /// Called before each step with how many are done and how many there are.
  std::function<void(int, int)> progress;
};

/// What a finished run was made by and with, compared with this program.
struct Provenance {
  /// The same program, libraries and kind of processor: the same bytes are promised.
  bool same_build = false;
  std::string build;  ///< the run's: "commit 1234567, gcc 12.2.0"
};

/// @throws InputError where this program cannot recompute the run: it is of another version of the
/// planner, or its networks or hand are not those that are here.
Provenance FindProvenance(const std::filesystem::path& run, const std::filesystem::path& weights);

/// Applies a finished run's journal again and writes what comes of it, without pictures, to the run
/// directory `target`.
/// @param comparison  gets each step's line with that of the run as it is done; where it is done()
/// the rest is left out, and `target` with it.
/// @throws InputError for a run that cannot be read; Interrupted.
void RecomputeRun(const std::filesystem::path& run, const std::filesystem::path& target,
                  const VerifyConfig& config, RunComparison& comparison);

/// What was found out about a finished run by recomputing it: left is the run.
struct Verification {
  Provenance provenance;
  int num_steps = 0;
  RunComparison comparison;
};
/// The largest distance of numbers that counts as the same where another build or another kind of
/// processor made the run (design, section 2.3).
inline constexpr double kOtherBuildTolerance = 1e-6;

/// Recomputes a run whose files are those of its manifest (VerifyManifest) and compares every one,
/// but for pictures, which must only be of its steps.
Verification VerifyRun(const std::filesystem::path& run, const VerifyConfig& config);

}  // namespace pregrasp
