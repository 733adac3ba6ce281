#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "app/core/thread_pool.h"
#include "app/geometry/signed_distance.h"
#include "app/job/planner.h"
#include "app/trajectory/robust.h"

namespace pregrasp {

/// What a job is made from. With its commands it is all that a result depends on.
struct JobSetup {
  Scene scene;  ///< loaded; with the hand that it names
  std::uint64_t seed = 1;
  PlannerConfig config;           ///< at the start; commands may change it
  std::filesystem::path weights;  ///< the folder with score.safetensors and generator.safetensors
};

/// What all commands of one job share: the world, built at once; the planner and what it loads,
/// built when a command first needs it. Its answers are functions of the setup alone.
class Job {
 public:
  /// @param threads  0: one per hardware thread; cannot change a result.
  /// @throws InputError for bodies that overlap or cannot be simulated, or a bad configuration.
  Job(JobSetup setup, int threads);
  ~Job();

  const JobSetup& setup() const { return setup_; }
  const Scene& scene() const { return world_->scene(); }
  const HandModel& hand() const { return HandOf(scene()); }
  const World& world() const { return *world_; }
  const std::shared_ptr<const World>& shared_world() const { return world_; }
  ThreadPool& pool();
  /// Signed distance to everything around the object, at the scene's start.
  const EnvironmentDistance& environment();

  /// The worlds in which certified plans are simulated again.
  const RobustWorlds& robust_worlds();

  /// The stages bound together for plans from `start`. The last one made is kept.
  /// @throws InputError for weights that are missing or damaged.
  std::shared_ptr<const Planner> GetPlanner(const WorldState& start, const PlannerConfig& config);

 private:
  JobSetup setup_;
  int threads_;
  std::shared_ptr<const World> world_;
  std::unique_ptr<ThreadPool> pool_;
  std::unique_ptr<EnvironmentDistance> environment_;
  std::unique_ptr<RobustWorlds> robust_worlds_;
  std::shared_ptr<const Planner> planner_;
};

}  // namespace pregrasp
