#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "app/dynamics/world.h"
#include "app/job/run_summary.h"
#include "app/scene/scene.h"

namespace pregrasp {

/// What a run is a function of besides its scene, and what else its files say about it.
struct RunInfo {  // NOLINT(bugprone-exception-escape): moving JSON does not throw
  std::uint64_t seed = 1;
  double dt = StepConfig{}.dt;  ///< the step of the certified simulation [s]
  /// Versions of libraries this folder cannot ask for itself ("simbody", "fcl", "assimp", "mesa");
  /// added to those it can (BuildLibraries).
  std::map<std::string, std::string> libraries;
  /// SHA-256 of the files beside the scene's that a result depends on, by name: weights, the hand.
  std::map<std::string, std::string> inputs;
  std::string command;     ///< the command line that makes the run again; may be empty
  std::string scene_file;  ///< as the user gave it; may be empty
  /// The planner's fields before any command, by full name: what a replay begins with.
  nlohmann::json settings_at_start = nlohmann::json::object();
  std::string error = {};  ///< that ended the run before its time; empty for none
};

/// The name under frames/ of the picture of step `number` (from 1): 1 and "scene.start" give
/// "0001_scene-start.png".
std::string PictureName(int number, const std::string& id);

/// Writes a run directory (app/recording/README.md has every file's schema). All goes to
/// DIR.partial, and Finish puts that in the place of DIR in one rename, so that DIR is absent, the
/// old run or the new run at every moment, also when this process is killed. One process at a time
/// may write a DIR.
///
/// Every function throws InputError, with one line that says why, when the disk is full, read-only
/// or the like; the destructor then removes all that was written.
class RunDirectory {
 public:
  /// Locks DIR, clears away what a killed run left, and writes scene.json and meshes/.
  /// @param scene  validated and loaded.
  /// @throws InputError when DIR holds anything but a finished run, is being written by another
  /// process, or cannot be written.
  RunDirectory(const std::filesystem::path& directory, const Scene& scene, RunInfo info = {});
  /// Removes DIR.partial if Finish did not succeed; DIR is then what it was before.
  ~RunDirectory();

  /// DIR.partial, for files that others write; whatever is in it at Finish belongs to the run.
  const std::filesystem::path& partial() const;
  const std::filesystem::path& directory() const;

  /// Where the picture of a step belongs: partial()/frames/NNNN_ID.png. The folder is made.
  std::filesystem::path PictureFile(int number, const std::string& step_id) const;

  /// Appends the step to run.rawlog (a CActionCollection and a CSensoryFrame), to steps.jsonl, and
  /// its command to journal.jsonl. @returns its number, from 1.
  int AddStep(const StepFacts& step);

  /// Appends a step whose picture is at PictureFile to pictures.jsonl and pictures.rawlog.
  /// @param shot  what the picture shows, as JSON.
  void AddPicture(const StepFacts& step, int number, const nlohmann::ordered_json& shot);

  /// Appends one row to rollout.csv. `state` is one of a world of this scene.
  void AddRolloutRow(const WorldState& state);

  /// What ended the run before its time, for manifest.json.
  void SetError(std::string error);

  /// Writes summary.json and manifest.json, closes everything and puts the run at DIR. Also for an
  /// interrupted run, with status "interrupted": what was recorded until then is a valid run.
  /// @param summary        its hash is filled in here.
  /// @param step           the id of the step that the summary and the tables are of.
  /// @param configuration  the resolved configuration, for manifest.json.
  void Finish(RunSummary summary, const std::string& step, const nlohmann::json& configuration);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pregrasp
