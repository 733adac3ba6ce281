#pragma once

#include "app/job/apply.h"

namespace pregrasp::internal {

// The parts of Apply, by stage. Each fills in what its verbs change in `next`, a copy of the state,
// and in the facts: id, details, and the world's part where it is not the start's.

/// What Apply works on.
struct Application {
  Job& job;
  const Command& command;
  JobState& next;
  StepFacts& facts;
  bool interrupted = false;
  /// Of an action that is to be stopped: the simulation after the whole of it. Null: it is done.
  const Simulation* whole = nullptr;
};

/// As Apply, for a simulation's action that was stopped (its option stopped_after) where the whole
/// of it is known: nothing is simulated.
Applied ApplyPart(Job& job, const std::shared_ptr<const JobState>& state, const Command& command,
                  const Simulation& whole);

void ApplyScene(Application& a);       // open, settle, verdict
void ApplyGraph(Application& a);       // mesh, score, prune, path
void ApplyTrajectory(Application& a);  // screen, iterate, certify
void ApplyGrasp(Application& a);       // grasp, lift
void ApplyMotion(Application& a);      // keyframe, fill, smooth, frame
void ApplySimulation(Application& a);  // touch, let_go, move, wait

/// Poses, fingers, contacts and time of `state` into the facts.
void SetWorldFacts(StepFacts& facts, const World& world, const WorldState& state,
                   const std::vector<ContactPoint>& contacts);

/// @throws InputError with what the command needs first, unless `condition` holds.
void Require(bool condition, const char* expected, const char* got);

}  // namespace pregrasp::internal
