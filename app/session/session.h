#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/core/memory_claim.h"
#include "app/job/timeline.h"
#include "app/session/recorder.h"

namespace pregrasp {

struct SessionConfig {
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: one per hardware thread; cannot change a result
  /// --pictures: overrules what is asked for later.
  std::optional<PictureMode> pictures;
  std::string command;  ///< the command line, for the footer of pictures and the manifest
  PlannerConfig planner;
  std::filesystem::path weights;  ///< the folder of the networks' weights
};

/// SHA-256 of the files that a result depends on beside the scene and the program, by name, as far
/// as they are there: the weights in that folder. The hand's stands in scene.json.
std::map<std::string, std::string> HashInputs(const std::filesystem::path& weights);

/// One scene under work: its job and timeline, where its simulations and plans begin, and its run
/// directory. Computes nothing itself: whatever is done is a command to the timeline.
class Session {
 public:
  using Node = Timeline::Node;

  /// @param scene  loaded. @throws InputError for bodies that overlap or cannot be simulated.
  Session(Scene scene, const SessionConfig& config);
  ~Session();

  const SessionConfig& config() const { return config_; }
  Job& job() { return *job_; }
  Timeline& timeline() { return *timeline_; }
  const Scene& scene() const { return job_->scene(); }
  const World& world() const { return job_->world(); }

  /// Where simulations and plans begin: the scene's start, or where Settle left it.
  const Node& start() const { return *start_; }
  WorldState GetStart() const { return timeline_->GetState(*start_)->start; }
  /// Lets the start alone for `seconds`; the start is then where that ended.
  /// @throws InputError once something follows the start.
  const Node& Settle(double seconds);

  /// A picture of a step, for the run directory.
  void Shoot(const Node& node, const Shot& shot);
  /// The same, drawn now and written to a file that belongs to no run.
  void ShootToFile(const Node& node, const Shot& shot, const std::filesystem::path& file);

  /// From now on steps go to a run directory as they come, those that there are first.
  /// @throws InputError when one is open already, or as RunDirectory does.
  void Record(const std::filesystem::path& directory, PictureMode pictures);

  /// Writes a run directory with everything up to now: at `directory`, or the one that is recorded
  /// to, which ends there. @param node  that the summary is of; null for the furthest one. @returns
  /// where it is.
  std::filesystem::path Save(const std::optional<std::filesystem::path>& directory,
                             const Node* node = nullptr);

  /// Ends the run directory that is recorded to, if there is one. @throws Interrupted without a
  /// status, and goes on recording; with one it does without pictures that were not drawn.
  /// @param status  of the summary in place of its own: "interrupted", "failed".
  /// @param error   what it failed for, for the manifest.
  void FinishRecording(const std::optional<std::string>& status = std::nullopt,
                       const Node* node = nullptr, const std::string& error = "");

  /// Writes a finished run directory with everything up to now, without pictures, and without
  /// asking what the summary of a whole run would: ResumeSession goes on from it.
  /// @param node  where it stands.
  void SaveState(const std::filesystem::path& directory, const Node& node);

  /// Takes the steps of a recorded run, the first being the start's (Timeline::Restore).
  void Restore(std::vector<StepFacts> steps, double tolerance);

  bool recording() const { return recorder_ != nullptr; }
  /// Draws its steps.
  PictureDrawer& drawer() { return *drawer_; }

  /// Count what this holds for whoever keeps it, where that asks for it: the second one what its
  /// timeline does.
  MemoryClaim& claim() { return claim_; }
  MemoryClaim& steps_claim() { return steps_claim_; }

 private:
  // @param pictures  whatever --pictures says.
  std::unique_ptr<Recorder> OpenRecorder(const std::filesystem::path& directory,
                                         PictureMode pictures);
  void Finish(Recorder& recorder, const std::optional<std::string>& status, const Node* node);
  void CompleteVerdict();

  MemoryClaim claim_, steps_claim_;
  SessionConfig config_;
  std::unique_ptr<Job> job_;
  std::unique_ptr<Timeline> timeline_;
  const Node* start_;
  std::unique_ptr<PictureDrawer> drawer_;
  std::map<int, Shot> shots_;  // by the node's number
  std::chrono::steady_clock::time_point opened_ = std::chrono::steady_clock::now();
  std::unique_ptr<Recorder> recorder_;
};

}  // namespace pregrasp
