#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/dynamics/world.h"
#include "app/recording/step_record.h"
#include "app/scene/scene.h"

namespace pregrasp {

/// Writes a run directory: everything goes to DIR.partial, and Finish renames it to DIR, so that
/// DIR is complete or absent at every moment. A finished run at DIR is replaced by that rename.
class RunDirectory {
 public:
  /// @throws InputError when DIR holds something that is not a run, is being written by another
  /// process, or cannot be written.
  explicit RunDirectory(std::filesystem::path directory);
  /// Removes DIR.partial if Finish was not called.
  ~RunDirectory();

  /// DIR.partial, for files others write (frames/).
  const std::filesystem::path& partial() const;
  const std::filesystem::path& directory() const;

  /// scene.json and meshes/: the resolved scene.
  void WriteScene(const Scene& scene);

  /// Appends the step to run.rawlog (a CActionCollection and a CSensoryFrame) and to steps.jsonl.
  void AddStep(const StepRecord& step);

  /// Appends one row to rollout.csv; the header comes from the world at the first call.
  void AddRolloutRow(const World& world, const WorldState& state);

  /// Writes summary.json and manifest.json, closes all, renames.
  /// @param summary   the fields of summary.json; `hash` is filled in here.
  /// @param settings  the resolved configuration and seed, for manifest.json.
  void Finish(nlohmann::json summary, const nlohmann::json& settings);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A run directory read back. @throws InputError if `directory` is not a finished run.
struct LoadedRun {
  nlohmann::json summary, manifest, scene;
  std::vector<StepRecord> steps;
};
LoadedRun LoadRun(const std::filesystem::path& directory);

}  // namespace pregrasp
