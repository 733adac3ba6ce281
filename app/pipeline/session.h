#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/core/thread_pool.h"
#include "app/geometry/signed_distance.h"
#include "app/pipeline/journal.h"
#include "app/job/motion_measure.h"
#include "app/pictures/picture.h"
#include "app/job/simulation.h"

namespace pregrasp {

struct SessionConfig {
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: one per hardware thread; cannot change a result
  /// --pictures: overrules what is asked for later.
  std::optional<PictureMode> pictures;
  std::string remake;  ///< the command that makes the pictures again, for their footer
};

/// One scene under work: its world, where it starts, and the journal of what was done. Composes the
/// stages; computes nothing itself.
///
/// Every action is a step with an id ("scene.start", "sim.3"): the same in the log, the picture and
/// Lua. Steps stay in memory until a run directory asks for them: Record opens one that gets each
/// step as it comes, Save writes one with all steps so far.
class Session {
 public:
  /// @param scene  loaded. @throws InputError for bodies that overlap or cannot be simulated.
  Session(Scene scene, const SessionConfig& config);
  ~Session();

  const Scene& scene() const { return world_->scene(); }
  const SessionConfig& config() const { return config_; }
  const World& world() const { return *world_; }
  const std::shared_ptr<const World>& shared_world() const { return world_; }
  const WorldState& start() const { return start_; }
  const std::string& last_step_id() const { return journal_.back().record.id; }
  ThreadPool& pool();
  /// Signed distance to everything around the object, at its start.
  const EnvironmentDistance& environment();

  /// Lets the start alone for `seconds`; the start is then where that ended, at t = 0.
  /// @throws InputError once something was simulated: its past begins at the start.
  SettleResult Settle(double seconds);

  /// A simulation from the start. Where it is traced, its steps and their pictures tell what the
  /// last physics step did, and the run directory has trace.jsonl.
  std::shared_ptr<Simulation> Simulate(bool traced = false);

  // What can be done to a simulation, each as one step of the journal. An interrupt ends an action
  // early: what was done is a step, and Interrupted goes on.
  void Touch(const std::shared_ptr<Simulation>& simulation, Finger finger, const Vector3& p_OC);
  void Lift(const std::shared_ptr<Simulation>& simulation, Finger finger);
  void Move(const std::shared_ptr<Simulation>& simulation, Finger finger, const Vector3& p_WTarget,
            double seconds);
  void Wait(const std::shared_ptr<Simulation>& simulation, double seconds);
  void Step(const std::shared_ptr<Simulation>& simulation, int steps);

  /// Takes back the last `steps` physics steps of the last action, of `simulation`: it is the step
  /// of the journal that it would have been, had it ended there.
  void Shorten(const std::shared_ptr<Simulation>& simulation, int steps);

  const JournalStep& last_step() const { return journal_.back(); }
  /// A simulation as it is now, as a step.
  JournalStep StepOf(const Simulation& simulation) const;

  /// A picture of a step, which it becomes part of if it is the last one; else the step is recorded
  /// again.
  void Shoot(const JournalStep& step, const JournalStep::Shot& shot);

  /// The same, drawn now and written to a file that belongs to no run.
  void ShootToFile(JournalStep step, const JournalStep::Shot& shot,
                   const std::filesystem::path& file);

  // What planning stages do, each as one step of the journal.

  /// A step with the poses and fingers of `state`, ready for its details, lines and overlay.
  JournalStep MakeStep(const std::string& id, const std::string& stage, const WorldState& state,
                       const std::vector<ContactPoint>& contacts) const;
  void AddStep(JournalStep step);
  /// What the run comes to, in place of the last simulation.
  void SetOutcome(RunOutcome outcome) { outcome_ = std::move(outcome); }

  /// From now on steps go to a run directory as they come, those that there are first.
  /// @throws InputError when one is open already, or as RunDirectory does.
  void Record(const std::filesystem::path& directory, PictureMode pictures);

  /// Writes a run directory with everything up to now: at `directory`, or the one that is recorded
  /// to, which ends there. @returns where it is.
  std::filesystem::path Save(const std::optional<std::filesystem::path>& directory);

  /// Ends the run directory that is recorded to, if there is one.
  /// @param status  of the summary: "interrupted", or none, as nothing was planned.
  void FinishRecording(const std::optional<std::string>& status = std::nullopt);

  bool recording() const { return recorder_ != nullptr; }

 private:
  void Act(const std::shared_ptr<Simulation>& simulation, const std::string& what,
           nlohmann::json details, const std::function<void()>& action);
  JournalStep StepOfAction() const;
  std::unique_ptr<JournalWriter> OpenWriter(const std::filesystem::path& directory,
                                            PictureMode pictures);
  RunOutcome OutcomeOfSimulation() const;
  void Finish(JournalWriter& writer, const std::optional<std::string>& status);

  SessionConfig config_;
  std::shared_ptr<const World> world_;
  WorldState start_;
  std::string start_id_ = "scene.start";  // of the step that ends at start_
  std::unique_ptr<ThreadPool> pool_;
  std::unique_ptr<EnvironmentDistance> environment_;
  std::unique_ptr<PictureDrawer> drawer_;
  std::vector<JournalStep> journal_;
  std::shared_ptr<const Simulation> last_;  // that acted last
  std::optional<RunOutcome> outcome_;       // of a plan
  int num_actions_ = 0;
  // Of the last action.
  WorldState before_;
  std::string what_;
  nlohmann::json details_;
  std::chrono::steady_clock::time_point opened_ = std::chrono::steady_clock::now();
  std::unique_ptr<JournalWriter> recorder_;
};

}  // namespace pregrasp
