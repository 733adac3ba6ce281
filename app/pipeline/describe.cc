#include "app/pipeline/describe.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/pipeline/forces.h"
#include "app/pipeline/motion_measure.h"

namespace pregrasp {
namespace {

constexpr double kMillimetre = 1e-3;

double Millimetres(double metres) {
  const double mm = std::round(metres / kMillimetre * 100.0) / 100.0;
  return mm == 0.0 ? 0.0 : mm;  // never "-0"
}

std::string DescribeSizes(const Shape& shape) {
  if (const Box* box = std::get_if<Box>(&shape)) {
    return fmt::format("box {} x {} x {} mm", Millimetres(box->size.x()),
                       Millimetres(box->size.y()), Millimetres(box->size.z()));
  }
  return ShapeKind(shape);
}

// How a finger fares: which sentence it gives, and the numbers behind it.
struct FingerStory {
  Finger finger = Finger::kThumb;
  const FingertipState* tip = nullptr;
  ForceSplit split;
  double slid = 0.0;  // over the surface in this step [m]
};

std::vector<FingerStory> FingersThatAreOn(const World& world, const WorldState& before,
                                          const WorldState& after) {
  std::vector<FingerStory> stories;
  for (int i = 0; i < kNumFingers; ++i) {
    const FingertipState& tip = after.fingers[i];
    if (!tip.on) continue;
    const Finger finger = static_cast<Finger>(i);
    const double slid_before = before.fingers[i].on ? before.fingers[i].slip : 0.0;
    stories.push_back({finger, &tip, SplitFingerForce(world, after, finger),
                       std::max(0.0, tip.slip - slid_before)});
  }
  return stories;
}

// One sentence: did the object follow, and what decided that.
std::string ExplainMotion(const World& world, const Motion& motion,
                          const std::vector<FingerStory>& fingers) {
  const std::string& name = world.scene().object().name;
  const bool moved = motion.moved > kMillimetre || motion.rotated > 0.01;
  if (fingers.empty()) {
    return moved ? fmt::format("Nothing touches the {} and it moves by itself.", name)
                 : fmt::format("Nothing touches the {} and it stays at rest.", name);
  }
  const FingerStory* pushing = &fingers.front();
  for (const FingerStory& story : fingers) {
    if (story.split.normal > pushing->split.normal) pushing = &story;
  }
  const std::string finger = FingerName(pushing->finger);
  if (!pushing->tip->touching) {
    return fmt::format("The {} does not press; the {} {}.", finger, name,
                       moved ? "moves without it" : "stays");
  }
  const double slid = pushing->slid;
  if (moved && slid > 0.2 * motion.moved + 0.5 * kMillimetre) {
    return fmt::format(
        "The {} slides {:.1f} mm over the {} while it moves: friction gives at most "
        "{:.2f} N.",
        finger, slid / kMillimetre, name, pushing->split.limit);
  }
  if (moved) {
    return fmt::format(
        "The {} sticks to the {} and takes it along: that needs {:.2f} N of friction, "
        "and {:.2f} N are there.",
        finger, name, pushing->split.tangential, pushing->split.limit);
  }
  if (slid > kMillimetre) {
    return fmt::format("The {} slides {:.1f} mm over the {}, which stays.", finger,
                       slid / kMillimetre, name);
  }
  return fmt::format("The {} presses with {:.2f} N and the {} stays.", finger,
                     pushing->split.normal, name);
}

}  // namespace

std::string FormatMillimetres(const Vector3& v) {
  return fmt::format("({}, {}, {}) mm", Millimetres(v.x()), Millimetres(v.y()), Millimetres(v.z()));
}

std::vector<std::string> DescribeStep(const World& world, const WorldState& before,
                                      const WorldState& after,
                                      const std::vector<ContactPoint>& contacts) {
  const Motion motion = CalcObjectMotion(world, before, after);
  const std::vector<FingerStory> fingers = FingersThatAreOn(world, before, after);
  std::vector<std::string> lines = {ExplainMotion(world, motion, fingers)};
  lines.push_back(fmt::format("{} moved\t{:.1f} mm, {:.1f} deg", world.scene().object().name,
                              motion.moved / kMillimetre, RadToDeg(motion.rotated)));
  for (const FingerStory& story : fingers) {
    const std::string name = FingerName(story.finger);
    lines.push_back(fmt::format("{} presses\t{:.2f} N", name, story.split.normal));
    lines.push_back(fmt::format("{} friction\t{:.2f} of {:.2f} N, {}", name, story.split.tangential,
                                story.split.limit, story.tip->slipping ? "slides" : "holds"));
  }
  for (const SupportForce& support : CalcSupportForces(world, contacts)) {
    const std::string& name = world.scene().bodies[support.body.value].name;
    lines.push_back(fmt::format("{} carries\t{:.2f} N", name, support.f_W.norm()));
    lines.push_back(fmt::format("{} friction\t{:.2f} of {:.2f} N, {}", name,
                                support.split.tangential, support.split.limit,
                                support.slipping ? "slides" : "holds"));
  }
  return lines;
}

std::vector<std::string> DescribeTrace(const StepTrace& trace) {
  double slip = 0.0;
  for (const ContactPoint& contact : trace.contacts) {
    if (contact.f_W.norm() > 1e-3) slip = std::max(slip, contact.v_slip_W.norm());
  }
  return {fmt::format("contact points\t{}, overlap {:.4f} mm at most", trace.contacts.size(),
                      trace.max_penetration / kMillimetre),
          fmt::format("fastest slip\t{:.2f} mm/s", slip / kMillimetre),
          fmt::format("energy\t{:.3f} mJ of motion, {:.3f} mJ of height",
                      1e3 * trace.kinetic_energy, 1e3 * trace.potential_energy)};
}

std::vector<std::string> DescribeScene(const Scene& scene) {
  std::vector<std::string> lines;
  for (const Body& body : scene.bodies) {
    const std::string mass =
        body.movable() ? fmt::format("{:.4g} g", 1e3 * body.mass_properties->mass) : "fixed";
    lines.push_back(fmt::format("{}\t{}, {}, friction {:.3g}", body.name, DescribeSizes(body.shape),
                                mass, body.friction));
  }
  lines.push_back(fmt::format("fingertips\tfriction {:.3g}, at most {:.3g} N",
                              scene.fingertips.friction, scene.fingertips.max_force));
  return lines;
}

}  // namespace pregrasp
