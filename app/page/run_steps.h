#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "app/recording/loaded_run.h"

namespace pregrasp {

/// The grasp on a way, the steps that led to an end, that a motion ends in; without a motion the
/// last feasible one, else the last; null for none.
const StepFacts* FindGrasp(const std::vector<const StepFacts*>& way);
/// The lift of that grasp on the way, else the last; null for none.
const StepFacts* FindLift(const std::vector<const StepFacts*>& way);

/// Which steps of a run, or of a session so far, matter, and how they hang together.
class RunSteps {
 public:
  explicit RunSteps(const LoadedRun& run);
  /// @param steps  all of them in the order of doing; what they point to outlives this.
  /// @param end    that the steps of interest led to.
  RunSteps(std::vector<const StepFacts*> steps, const StepFacts& end, const FactsSource& source);

  /// The step that the run's summary is of.
  const StepFacts& end() const { return *end_; }
  /// Those that led to it, the start first.
  const std::vector<const StepFacts*>& way() const { return way_; }
  bool IsOnWay(const StepFacts& step) const { return on_way_.count(step.id) > 0; }
  /// From 1, as LoadedRun::number_of.
  int NumberOf(const StepFacts& step) const { return number_of_.at(&step); }

  /// What the run is told by, in its order: verdicts on the start; key steps (IsKeyStep) on the
  /// way, with its grasp and lift, and where the way ends; and, from beside the way, the first
  /// plan, the first grasp and the first lift that failed, where none on the way did. The hand's
  /// motion comes last and in time, whatever its keyframes were solved in. At most `most`: of
  /// iterations and of keyframes those are taken that lie evenly.
  std::vector<const StepFacts*> FindStory(std::size_t most) const;

 private:
  // On the way if there is one, else the first.
  const StepFacts* FindFailure(Verb verb) const;

  std::vector<const StepFacts*> steps_;
  const FactsSource& source_;
  const StepFacts* end_ = nullptr;
  std::map<const StepFacts*, int> number_of_;
  std::vector<const StepFacts*> way_;
  std::set<std::string> on_way_;
};

}  // namespace pregrasp
