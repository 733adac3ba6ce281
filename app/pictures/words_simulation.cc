#include <fmt/format.h>

#include <algorithm>

#include "app/pictures/forces.h"
#include "app/pictures/words.h"

namespace pregrasp::internal {
namespace {

// How a finger fares: which sentence it gives, and the numbers behind it.
struct FingerStory {
  const FingerFacts* finger = nullptr;
  ForceSplit split;
  double slid_mm = 0.0;  // over the surface in this step
};

std::vector<FingerStory> FingersThatAreOn(const Scene& scene, const StepFacts& before,
                                          const StepFacts& after) {
  std::vector<FingerStory> stories;
  for (std::size_t i = 0; i < after.fingers.size(); ++i) {
    const FingerFacts& finger = after.fingers[i];
    if (!finger.on) continue;
    const double slid_before = before.fingers[i].on ? before.fingers[i].slip : 0.0;
    stories.push_back({&finger, SplitFingerForce(scene, after.object().q_WB, finger),
                       1e3 * std::max(0.0, finger.slip - slid_before)});
  }
  return stories;
}

// One sentence: did the object follow, and what decided that.
std::string ExplainMotion(const std::string& name, const SimulationFacts& facts,
                          const std::vector<FingerStory>& fingers) {
  const bool moved = facts.moved_mm > 1.0 || DegToRad(facts.rotated_deg) > 0.01;
  if (fingers.empty()) {
    return moved ? fmt::format("No finger touches the {} and it moves by itself.", name)
                 : fmt::format("No finger touches the {} and it stays at rest.", name);
  }
  const FingerStory* pushing = &fingers.front();
  for (const FingerStory& story : fingers) {
    if (story.split.normal > pushing->split.normal) pushing = &story;
  }
  const std::string finger = FingerName(pushing->finger->finger);
  if (!pushing->finger->touching) {
    return fmt::format("The {} does not press; the {} {}.", finger, name,
                       moved ? "moves without it" : "stays");
  }
  if (moved && pushing->slid_mm > 0.2 * facts.moved_mm + 0.5) {
    return fmt::format(
        "The {} slides {:.1f} mm over the {} while it moves: friction gives at most {:.2f} N.",
        finger, pushing->slid_mm, name, pushing->split.limit);
  }
  if (moved) {
    return fmt::format(
        "The {} sticks to the {}, which moves: that needs {:.2f} N of friction, and {:.2f} N "
        "are there.",
        finger, name, pushing->split.tangential, pushing->split.limit);
  }
  if (pushing->slid_mm > 1.0) {
    return fmt::format("The {} slides {:.1f} mm over the {}, which stays.", finger,
                       pushing->slid_mm, name);
  }
  return fmt::format("The {} presses with {:.2f} N and the {} stays.", finger,
                     pushing->split.normal, name);
}

// What was done.
std::string DescribeAction(const Scene& scene, const StepFacts& step, const StepFacts& before) {
  const nlohmann::json& options = step.command.options;
  const auto finger_of = [&](const StepFacts& facts) -> const FingerFacts& {
    return *std::find_if(facts.fingers.begin(), facts.fingers.end(), [&](const FingerFacts& f) {
      return FingerName(f.finger) == options.at("finger").get<std::string>();
    });
  };
  switch (step.command.verb) {
    case Verb::kTouch:
      return fmt::format("The {} touches the {} at {}.", options.at("finger").get<std::string>(),
                         scene.object().name, FormatMillimetres(finger_of(step).p_OC));
    case Verb::kLetGo:
      return fmt::format("The {} lifts off.", options.at("finger").get<std::string>());
    case Verb::kMove: {
      const auto& to = options.at("p_WTarget");
      const Vector3 by = Vector3(to[0], to[1], to[2]) - finger_of(before).p_WTarget;
      return fmt::format("The {}'s target moves by {} in {:.3g} s.",
                         options.at("finger").get<std::string>(), FormatMillimetres(by),
                         options.at("seconds").get<double>());
    }
    default:
      if (options.contains("steps")) {
        const int steps = options.at("steps").get<int>();
        return fmt::format("{} physics step{}.", steps, steps == 1 ? "" : "s");
      }
      return fmt::format("Nothing is moved for {:.3g} s.", options.at("seconds").get<double>());
  }
}

void AddTrace(const StepFacts& step, const SimulationFacts::Trace& trace,
              std::vector<std::string>& lines) {
  double slip = 0.0;
  for (const ContactFacts& contact : step.contacts) {
    if (contact.f_W.norm() > 1e-3) slip = std::max(slip, contact.v_slip_W.norm());
  }
  lines.push_back(fmt::format("contact points\t{}, overlap {:.4f} mm at most", step.contacts.size(),
                              1e3 * trace.max_penetration));
  lines.push_back(fmt::format("fastest slip\t{:.2f} mm/s", 1e3 * slip));
  lines.push_back(fmt::format("energy\t{:.3f} mJ of motion, {:.3f} mJ of height",
                              1e3 * trace.kinetic_energy, 1e3 * trace.potential_energy));
}

}  // namespace

std::vector<std::string> DescribeSimulation(const Scene& scene, const StepFacts& step,
                                            const StepFacts& before) {
  const auto& facts = std::get<SimulationFacts>(step.details);
  const std::string& name = scene.object().name;
  const std::vector<FingerStory> fingers = FingersThatAreOn(scene, before, step);
  std::vector<std::string> lines = {DescribeAction(scene, step, before),
                                    ExplainMotion(name, facts, fingers)};
  if (facts.stopped) {
    lines.push_back(fmt::format("stopped after\t{} physics steps", facts.physics_steps));
  }
  lines.push_back(
      fmt::format("{} moved\t{:.1f} mm, {:.1f} deg", name, facts.moved_mm, facts.rotated_deg));
  for (const FingerStory& story : fingers) {
    const std::string finger = FingerName(story.finger->finger);
    lines.push_back(fmt::format("{} presses\t{:.2f} N", finger, story.split.normal));
    lines.push_back(fmt::format("{} friction\t{:.2f} of {:.2f} N, {}", finger,
                                story.split.tangential, story.split.limit,
                                story.finger->slipping ? "slides" : "holds"));
  }
  for (const SupportForce& support : CalcSupportForces(scene, step.contacts)) {
    const std::string& body = scene.bodies[support.body].name;
    lines.push_back(fmt::format("{} carries\t{:.2f} N", body, support.f_W.norm()));
    lines.push_back(fmt::format("{} friction\t{:.2f} of {:.2f} N, {}", body,
                                support.split.tangential, support.split.limit,
                                support.slipping ? "slides" : "holds"));
  }
  if (facts.trace) AddTrace(step, *facts.trace, lines);
  return lines;
}

}  // namespace pregrasp::internal
