#include "app/job/job_state.h"

namespace pregrasp {

void JobState::ForgetGraph() {
  graph.reset();
  paths.reset();
  ForgetPath();
}

void JobState::ForgetPath() {
  path.reset();
  mppi.reset();
  optimization.reset();
  screen_rounds = 0;
  ForgetTrajectory();
}

void JobState::ForgetTrajectory() {
  certificate.reset();
  release.reset();
  ForgetGrasps();
}

void JobState::ForgetGrasps() {
  grasps.reset();
  num_grasps = 0;
  prepared_lifts.reset();
  lifts.clear();
  ForgetMotion();
}

void JobState::ForgetMotion() {
  chosen_grasp = 0;
  motion.reset();
  motion_state.reset();
}

Progress CalcProgress(const JobState& state) {
  using Reached = Progress::Reached;
  Progress progress;
  if (!state.certificate) return progress;
  progress.reached = Reached::kTrajectory;
  if (!state.certificate->certified) return progress;
  progress.reached = Reached::kCertified;
  for (int i = 0; i < state.num_grasps; ++i) {
    progress.feasible += state.grasps->grasps[i].feasible() ? 1 : 0;
  }
  if (progress.feasible > 0) progress.reached = Reached::kFeasible;
  for (const auto& [number, lift] : state.lifts) progress.lifted += lift->held ? 1 : 0;
  if (progress.lifted > 0) progress.reached = Reached::kLifted;
  const bool finished = state.motion && state.motion_state->finished;
  if (finished && state.lifts.at(state.chosen_grasp)->held &&
      state.motion->Summarize(*state.motion_state).failed == 0) {
    const bool disturbed = state.certificate->neighbours.disturbed ||
                           state.lifts.at(state.chosen_grasp)->neighbours.disturbed;
    progress.reached = disturbed ? Reached::kMoved : Reached::kOk;
  }
  return progress;
}

}  // namespace pregrasp
