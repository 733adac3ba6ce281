#include "app/job/run_steps.h"

namespace pregrasp {

RunPlace TakeRunSteps(Timeline& timeline, const RunConfig& config, int steps,
                      const std::function<bool(const RunPlace&)>& more) {
  RunPlace place;
  if (steps == 0) return place;
  // The gate is taken away however this ends.
  struct Gate {
    Timeline& timeline;
    ~Gate() { timeline.SetGate({}); }
  };
  const Gate gate{timeline};
  timeline.SetGate([&](const Timeline::Node& node) {
    place.node = &node;
    ++place.steps;
    return place.steps < steps && (!more || more(place));
  });
  try {
    place.result = RunPlanner(timeline, config,
                              [&](const RunProgress& progress) { place.progress = progress; });
  } catch (const Paused&) {
    // as asked for
  }
  return place;
}

}  // namespace pregrasp
