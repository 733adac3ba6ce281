#include "app/pictures/words.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

namespace pregrasp {
namespace {

// To a hundredth, and never "-0".
double Rounded(double mm) {
  const double rounded = std::round(mm * 100.0) / 100.0;
  return rounded == 0.0 ? 0.0 : rounded;
}

struct Sizes {
  std::string operator()(const Box& box) const {
    return fmt::format("box {} x {} x {} mm", Rounded(1e3 * box.size.x()),
                       Rounded(1e3 * box.size.y()), Rounded(1e3 * box.size.z()));
  }
  std::string operator()(const Cylinder& cylinder) const {
    return fmt::format("cylinder {} mm across, {} mm high", Rounded(2e3 * cylinder.radius),
                       Rounded(1e3 * cylinder.height));
  }
  std::string operator()(const Capsule& capsule) const {
    return fmt::format("capsule {} mm across, {} mm long", Rounded(2e3 * capsule.radius),
                       Rounded(1e3 * (capsule.height + 2.0 * capsule.radius)));
  }
  std::string operator()(const Sphere& sphere) const {
    return fmt::format("sphere {} mm across", Rounded(2e3 * sphere.radius));
  }
  std::string operator()(const Mesh& mesh) const {
    return fmt::format("mesh of {} triangles", mesh.mesh.F.rows());
  }
  std::string operator()(const Cloud& cloud) const {
    return fmt::format("cloud of {} points", cloud.points.rows());
  }
  std::string operator()(const Union& whole) const {
    return fmt::format("union of {}", whole.parts.size());
  }
};

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
    lines.push_back(fmt::format("{}\t{}, {}, friction {:.3g}", body.name,
                                std::visit(Sizes{}, body.shape), mass, body.friction));
  }
  lines.push_back(fmt::format("fingertips\tfriction {:.3g}, at most {:.3g} N",
                              scene.fingertips.friction, scene.fingertips.max_force));
  return lines;
}

std::string DescribeRowDifferences(const std::vector<std::string>& left,
                                   const std::vector<std::string>& right, std::size_t most) {
  std::map<std::string, std::string> others;
  for (const std::string& line : right) {
    const auto tab = line.find('\t');
    if (tab != std::string::npos) others.emplace(line.substr(0, tab), line.substr(tab + 1));
  }
  std::string text;
  std::size_t count = 0;
  for (const std::string& line : left) {
    const auto tab = line.find('\t');
    if (tab == std::string::npos || count == most) continue;
    const auto other = others.find(line.substr(0, tab));
    const std::string value = line.substr(tab + 1);
    if (other == others.end() || other->second == value) continue;
    text += fmt::format("{}{}: A {}, B {}", count++ == 0 ? "" : "; ", other->first, value,
                        other->second);
  }
  return text;
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
