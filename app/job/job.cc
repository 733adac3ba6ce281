#include "app/job/job.h"

#include <fmt/format.h>

#include "app/core/error.h"
#include "app/geometry/overlap.h"

namespace pregrasp {
namespace {

std::shared_ptr<const World> BuildWorld(const Scene& scene) {
  const std::vector<Overlap> overlaps = FindOverlaps(scene);
  if (!overlaps.empty()) {
    const Overlap& deepest = overlaps.front();
    const Body& a = scene.bodies[deepest.body_a];
    const Body& b = scene.bodies[deepest.body_b];
    throw InputError(a.where, a.name, "bodies that do not overlap",
                     fmt::format("{:.3g} mm of overlap with \"{}\"", 1e3 * deepest.depth, b.name));
  }
  return std::make_shared<const World>(scene);
}

bool SamePoses(const WorldState& a, const WorldState& b) {
  for (std::size_t i = 0; i < a.bodies.size(); ++i) {
    if (a.bodies[i].p_WB != b.bodies[i].p_WB ||
        a.bodies[i].q_WB.coeffs() != b.bodies[i].q_WB.coeffs()) {
      return false;
    }
  }
  return true;
}

// Whether a planner made with `a` is, but for its settings, the one that `b` would make.
bool SameBase(const PlannerConfig& a, const PlannerConfig& b) {
  return a.cloud_points == b.cloud_points && a.mesh.triangles == b.mesh.triangles &&
         a.mesh.convex_share == b.mesh.convex_share;
}

}  // namespace

Job::Job(JobSetup setup, int threads) : setup_(std::move(setup)), threads_(threads) {
  setup_.config.Validate();
  TakeHand(setup_.scene);
  world_ = BuildWorld(setup_.scene);
}

Job::~Job() = default;

ThreadPool& Job::pool() {
  if (!pool_) pool_ = std::make_unique<ThreadPool>(threads_);
  return *pool_;
}

const EnvironmentDistance& Job::environment() {
  if (!environment_) environment_ = std::make_unique<EnvironmentDistance>(scene());
  return *environment_;
}

const RobustWorlds& Job::robust_worlds() {
  if (!robust_worlds_) robust_worlds_ = std::make_unique<RobustWorlds>(scene(), world_->config());
  return *robust_worlds_;
}

std::shared_ptr<const Planner> Job::GetPlanner(const WorldState& start,
                                               const PlannerConfig& config) {
  if (!planner_ || !SamePoses(planner_->start(), start) || !SameBase(planner_->config(), config)) {
    planner_ = std::make_shared<const Planner>(world_, hand(), start, config, setup_.seed, pool(),
                                               setup_.weights);
  }
  return planner_;
}

}  // namespace pregrasp
