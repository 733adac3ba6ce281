#pragma once

#include <memory>

#include "app/job/job.h"
#include "app/job/job_state.h"
#include "app/job/step_facts.h"

namespace pregrasp {

/// What a command came to.
struct Applied {
  std::shared_ptr<const JobState> state;
  StepFacts facts;  ///< its id without a branch's ~n, which only a timeline knows
  /// The user interrupted physics of a simulation by hand: what was done until then is the step.
  bool interrupted = false;
};

/// The one way through the planner: does what `command` says to `state`, and tells it. A function
/// of its arguments: the same job, state and command give the same facts to the last bit, on any
/// number of threads.
/// @param state  null for Verb::kOpen only.
/// @throws InputError for a command that does not fit the state, or options out of range;
/// Interrupted.
Applied Apply(Job& job, const std::shared_ptr<const JobState>& state, const Command& command);

/// Which of the summary's `seconds` a verb's time belongs to: "geometry", "graph", "trajectory",
/// "grasp", "motion"; "" for none.
const char* TimedStage(Verb verb);

}  // namespace pregrasp
