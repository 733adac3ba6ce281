#include "app/pictures/words.h"

#include <fmt/format.h>

#include <cmath>

namespace pregrasp {
namespace {

// To a hundredth, and never "-0".
double Rounded(double mm) {
  const double rounded = std::round(mm * 100.0) / 100.0;
  return rounded == 0.0 ? 0.0 : rounded;
}

std::string DescribeSizes(const Shape& shape) {
  if (const Box* box = std::get_if<Box>(&shape)) {
    return fmt::format("box {} x {} x {} mm", Rounded(1e3 * box->size.x()),
                       Rounded(1e3 * box->size.y()), Rounded(1e3 * box->size.z()));
  }
  return ShapeKind(shape);
}

}  // namespace

std::string FormatMillimetres(const Vector3& v) {
  return fmt::format("({}, {}, {}) mm", Rounded(1e3 * v.x()), Rounded(1e3 * v.y()),
                     Rounded(1e3 * v.z()));
}

std::vector<std::string> internal::DescribeScene(const Scene& scene) {
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

std::vector<std::string> DescribeStep(const Scene& scene, const StepFacts& step,
                                      const FactsSource& steps) {
  switch (step.command.verb) {
    case Verb::kOpen:
      return internal::DescribeScene(scene);
    case Verb::kTouch:
    case Verb::kLetGo:
    case Verb::kMove:
    case Verb::kWait:
      return internal::DescribeSimulation(scene, step, steps.Get(step.command.node));
    default:
      return internal::DescribePlanning(scene, step);
  }
}

}  // namespace pregrasp
