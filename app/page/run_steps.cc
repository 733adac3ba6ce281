#include "app/page/run_steps.h"

#include <algorithm>
#include <tuple>

#include "app/core/error.h"
#include "app/pictures/overlay.h"

namespace pregrasp {
namespace {

std::vector<const StepFacts*> StepsOf(const LoadedRun& run) {
  std::vector<const StepFacts*> steps;
  for (const StepFacts& step : run.steps) steps.push_back(&step);
  return steps;
}

// @throws InputError for a run without steps.
const StepFacts& EndOf(const LoadedRun& run) {
  if (run.steps.empty()) {
    throw InputError(run.directory.string(), "", "a run with a step at least", "none");
  }
  return run.Get(run.manifest.value("step", run.steps.back().id));
}

// `count` of them, evenly, the first and the last among them.
std::vector<const StepFacts*> TakeEvenly(const std::vector<const StepFacts*>& steps,
                                         std::size_t count) {
  if (steps.size() <= count) return steps;
  std::vector<const StepFacts*> some;
  for (std::size_t i = 0; i < count; ++i) {
    some.push_back(steps[count == 1 ? 0 : i * (steps.size() - 1) / (count - 1)]);
  }
  return some;
}

bool HasFailed(const StepFacts& step) {
  if (const auto* plan = std::get_if<CertifyFacts>(&step.details)) return !plan->certified;
  if (const auto* grasp = std::get_if<GraspFacts>(&step.details)) return !grasp->feasible;
  if (const auto* lift = std::get_if<LiftFacts>(&step.details)) return !lift->held;
  return false;
}

bool IsByHand(Verb verb) {
  return verb == Verb::kTouch || verb == Verb::kLetGo || verb == Verb::kMove || verb == Verb::kWait;
}

}  // namespace

const StepFacts* FindGrasp(const std::vector<const StepFacts*>& way) {
  int entry = 0;
  for (const StepFacts* step : way) {
    if (const auto* frame = std::get_if<FrameFacts>(&step->details)) entry = frame->grasp;
    if (const auto* motion = std::get_if<MotionFacts>(&step->details)) entry = motion->grasp;
  }
  const StepFacts* chosen = nullptr;
  for (const StepFacts* step : way) {
    const auto* grasp = std::get_if<GraspFacts>(&step->details);
    if (grasp == nullptr) continue;
    const bool better =
        chosen == nullptr || grasp->feasible || !std::get<GraspFacts>(chosen->details).feasible;
    if (entry > 0 ? grasp->entry == entry : better) chosen = step;
  }
  return chosen;
}

const StepFacts* FindLift(const std::vector<const StepFacts*>& way) {
  const StepFacts* grasp = FindGrasp(way);
  const StepFacts* chosen = nullptr;
  for (const StepFacts* step : way) {
    const auto* lift = std::get_if<LiftFacts>(&step->details);
    if (lift == nullptr) continue;
    if (grasp != nullptr && lift->grasp == std::get<GraspFacts>(grasp->details).entry) return step;
    chosen = step;
  }
  return chosen;
}

RunSteps::RunSteps(const LoadedRun& run) : RunSteps(StepsOf(run), EndOf(run), run) {}

RunSteps::RunSteps(std::vector<const StepFacts*> steps, const StepFacts& end,
                   const FactsSource& source)
    : steps_(std::move(steps)), source_(source), end_(&end) {
  for (const StepFacts* step : steps_) {
    number_of_.emplace(step, static_cast<int>(number_of_.size()) + 1);
  }
  for (const StepFacts* at = end_;; at = &source_.Get(at->command.node)) {
    way_.push_back(at);
    on_way_.insert(at->id);
    if (at->command.node.empty()) break;
  }
  std::reverse(way_.begin(), way_.end());
}

const StepFacts* RunSteps::FindFailure(Verb verb) const {
  const StepFacts* first = nullptr;
  for (const StepFacts* step : steps_) {
    if (step->command.verb != verb || !HasFailed(*step)) continue;
    if (IsOnWay(*step)) return step;
    if (first == nullptr) first = step;
  }
  return first;
}

std::vector<const StepFacts*> RunSteps::FindStory(std::size_t most) const {
  std::set<const StepFacts*> told = {end_,
                                     FindGrasp(way_),
                                     FindLift(way_),
                                     FindFailure(Verb::kCertify),
                                     FindFailure(Verb::kGrasp),
                                     FindFailure(Verb::kLift)};
  told.erase(nullptr);
  std::vector<const StepFacts*> iterations, keyframes, actions;
  for (const StepFacts* each : steps_) {
    const StepFacts& step = *each;
    const Verb verb = step.command.verb;
    if (verb == Verb::kVerdict || verb == Verb::kSettle) told.insert(&step);
    if (!IsOnWay(step) || told.count(&step) > 0) continue;
    if (IsByHand(verb)) {
      actions.push_back(&step);
    } else if (verb != Verb::kPath && !IsKeyStep(step, source_)) {
      continue;
    } else if (verb == Verb::kIterate) {
      iterations.push_back(&step);
    } else if (verb == Verb::kKeyframe) {
      keyframes.push_back(&step);
    } else if (verb != Verb::kGrasp && verb != Verb::kLift) {
      told.insert(&step);
    }
  }
  constexpr std::size_t kIterations = 4, kLeast = 2;
  iterations = TakeEvenly(iterations, kIterations);
  told.insert(iterations.begin(), iterations.end());
  for (const auto& many : {keyframes, actions}) {
    const std::size_t room = most > told.size() ? most - told.size() : 0;
    const std::vector<const StepFacts*> some = TakeEvenly(many, std::max(room, kLeast));
    told.insert(some.begin(), some.end());
  }
  std::vector<const StepFacts*> story(told.begin(), told.end());
  // The motion comes last and in time, in whatever order its keyframes were solved.
  const auto place = [this](const StepFacts* step) {
    const bool moves = std::holds_alternative<FrameFacts>(step->details);
    return std::tuple(moves, moves ? step->t : 0.0, NumberOf(*step));
  };
  std::sort(story.begin(), story.end(),
            [&](const StepFacts* a, const StepFacts* b) { return place(a) < place(b); });
  return TakeEvenly(story, most);
}

}  // namespace pregrasp
