#include <fmt/format.h>

#include <algorithm>

#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/job/apply_stages.h"
#include "app/job/motion_measure.h"

namespace pregrasp::internal {
namespace {

Finger ReadFinger(const CommandOptions& options, const TipSpheres& tips) {
  const std::string name = options.Text("finger");
  const auto end = kFingerNames.begin() + tips.count;
  const auto found = std::find(kFingerNames.begin(), end, name);
  if (found == end)
    throw InputError("", "finger", "the name of a finger of the hand", '"' + name + '"');
  return static_cast<Finger>(found - kFingerNames.begin());
}

Vector3 ReadPoint(const CommandOptions& options, const char* name) {
  const nlohmann::json& value = options.Get(name);
  if (!value.is_array() || value.size() != 3) throw InputError("", name, "a point", value.dump());
  return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
}

void Act(const Command& command, Simulation& simulation) {
  const CommandOptions options(command);
  const TipSpheres& tips = simulation.world().scene().tips;
  switch (command.verb) {
    case Verb::kTouch:
      return simulation.Touch(ReadFinger(options, tips), ReadPoint(options, "p_OC"));
    case Verb::kLetGo:
      return simulation.Lift(ReadFinger(options, tips));
    case Verb::kMove:
      return simulation.Move(ReadFinger(options, tips), ReadPoint(options, "p_WTarget"),
                             options.Number("seconds"));
    default:
      return simulation.Step(options.Has("steps") ? options.Int("steps")
                                                  : simulation.StepsIn(options.Number("seconds")));
  }
}

}  // namespace

void ApplySimulation(Application& a) {
  const CommandOptions options(a.command);
  const bool traced = options.Has("trace") && options.Get("trace").get<bool>();
  Simulation simulation = a.next.simulation
                              ? *a.next.simulation
                              : Simulation(a.job.shared_world(), a.next.start, traced);
  const WorldState before = simulation.state();
  const int first = simulation.num_states();
  SimulationFacts facts;
  if (a.whole != nullptr) {
    simulation = *a.whole;
  } else {
    try {
      Act(a.command, simulation);
    } catch (const Interrupted&) {
      a.interrupted = true;
    }
  }
  // Redone, an action ends where it was stopped.
  if (options.Has("stopped_after")) {
    const int steps = options.Int("stopped_after"), done = simulation.num_states() - first;
    if (steps < 0 || steps > done) {
      throw InputError("", "stopped_after", fmt::format("0 to {} steps", done),
                       std::to_string(steps));
    }
    simulation.Back(done - steps);
    facts.stopped = true;
  }
  facts.stopped = facts.stopped || a.interrupted;
  facts.physics_steps = simulation.num_states() - first;
  if (a.interrupted) a.facts.command.options["stopped_after"] = facts.physics_steps;
  const Motion motion = CalcObjectMotion(a.job.world(), before, simulation.state());
  facts.moved_mm = 1e3 * motion.moved;
  facts.rotated_deg = RadToDeg(motion.rotated);
  if (simulation.traced() && simulation.num_states() > 1) {
    const StepTrace& trace = simulation.trace_at(simulation.num_states() - 1);
    facts.trace = {trace.max_penetration, trace.kinetic_energy, trace.potential_energy};
  }
  a.facts.id = fmt::format("sim.{}", ++a.next.num_actions);
  SetWorldFacts(a.facts, a.job.world(), simulation.state(), simulation.contacts());
  a.facts.details = std::move(facts);
  a.next.simulation = std::make_shared<const Simulation>(std::move(simulation));
}

}  // namespace pregrasp::internal
