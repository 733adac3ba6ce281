#include "app/job/check.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/dynamics/world.h"
#include "app/geometry/hull.h"
#include "app/geometry/mass_properties.h"
#include "app/geometry/overlap.h"
#include "app/geometry/tessellate.h"
#include "app/job/motion_measure.h"

namespace pregrasp {
namespace {

using Severity = CheckFinding::Severity;

constexpr double kLargeObject = 2.0, kSmallObject = 0.002;  // [m], longest edge of its box
constexpr double kWidePieces = 1e-3;  // [m], how far pieces may reach outside their shape
constexpr double kLightest = 20.0, kHeaviest = 20000.0;  // [kg/m^3]: foam, osmium

class Checker {
 public:
  explicit Checker(const Scene& scene) : scene_(scene) {}

  std::vector<CheckFinding> Run() {
    CheckOverlaps();
    if (findings_.empty()) CheckRest();  // what overlaps is pushed apart and never at rest
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) CheckUnits(scene_.bodies[i], i == 0);
    for (const Body& body : scene_.bodies) CheckPieces(body);
    for (const std::string& departure : RuleDepartures(scene_)) {
      Add(Severity::kWarning, WhereOf(departure),
          departure + ": the results count as outside the rules");
    }
    std::stable_sort(
        findings_.begin(), findings_.end(),
        [](const CheckFinding& a, const CheckFinding& b) { return a.severity > b.severity; });
    return std::move(findings_);
  }

 private:
  void Add(Severity severity, const std::string& where, const std::string& message) {
    findings_.push_back({severity, where, message});
  }

  // The line of the body that the sentence names, else of the scene.
  std::string WhereOf(const std::string& sentence) const {
    for (const Body& body : scene_.bodies) {
      if (sentence.find('"' + body.name + '"') != std::string::npos) return body.where;
    }
    return scene_.where.empty() ? scene_.file : scene_.where;
  }

  void CheckOverlaps() {
    for (const Overlap& overlap : FindOverlaps(scene_)) {
      const Body& a = scene_.bodies[overlap.body_a];
      const Body& b = scene_.bodies[overlap.body_b];
      Add(Severity::kError, a.where,
          fmt::format("\"{}\" overlaps \"{}\" by {:.3g} mm", a.name, b.name, 1e3 * overlap.depth));
    }
  }

  void CheckRest() {
    const World world(scene_);
    WorldState state = world.InitialState();
    const SettleResult settled = Settle(world, state, 1.0);
    if (settled.at_rest) return;
    const auto body =
        std::find_if(scene_.bodies.begin(), scene_.bodies.end(),
                     [&](const Body& candidate) { return candidate.name == settled.largest.body; });
    Add(Severity::kError, body->where,
        fmt::format("\"{}\" is not at rest: within 1 s it moves {:.3g} mm, and something turns by "
                    "{:.3g} deg (allowed: 1 mm and 0.5 deg){}",
                    body->name, 1e3 * settled.largest.moved, RadToDeg(settled.largest.rotated),
                    IsFloating(*body) ? "; it floats, as nothing is below it within 0.1 mm" : ""));
  }

  // Whether no other body comes near it at the start.
  bool IsFloating(const Body& body) const {
    Scene grown = scene_;
    const auto index = static_cast<std::size_t>(&body - scene_.bodies.data());
    constexpr double kNear = 1e-4;  // [m]
    grown.bodies[index].X_WB.translation() +=
        kNear * scene_.gravity / std::max(1e-9, scene_.gravity.norm());
    const std::vector<Overlap> overlaps = FindOverlaps(grown, 0.0);
    return std::none_of(overlaps.begin(), overlaps.end(), [&](const Overlap& overlap) {
      return overlap.body_a == static_cast<int>(index) || overlap.body_b == static_cast<int>(index);
    });
  }

  void CheckUnits(const Body& body, bool object) {
    const TriangleMesh mesh = Tessellate(body.shape, 16);
    const Vector3 size = mesh.V.colwise().maxCoeff() - mesh.V.colwise().minCoeff();
    const double longest = size.maxCoeff();
    if (object && (longest > kLargeObject || longest < kSmallObject)) {
      Add(Severity::kWarning, body.where,
          fmt::format("\"{}\" is {:.3g} m long; a hand handles 2 mm to 2 m (are its sizes in "
                      "metres?)",
                      body.name, longest));
    }
    if (!body.movable()) return;
    const double mass = body.mass_properties->mass;
    const double density = mass / std::max(1e-12, CalcVolume(body.shape));
    if (density < kLightest || density > kHeaviest) {
      Add(Severity::kWarning, body.where,
          fmt::format("\"{}\" has {:.3g} kg/m^3 ({:.3g} kg); usual are 20 to 20000 (is its mass in "
                      "kg, are its sizes in metres?)",
                      body.name, density, mass));
    }
  }

  // Contact simulation sees a shape's convex pieces.
  void CheckPieces(const Body& body) {
    const double protrusion = CalcProtrusion(body.shape, DecomposeConvex(body.shape));
    if (protrusion < kWidePieces) return;
    Add(Severity::kWarning, body.where,
        fmt::format("\"{}\" is {:.1f} mm thicker in contact than its mesh in places: it takes too "
                    "many convex pieces",
                    body.name, 1e3 * protrusion));
  }

  const Scene& scene_;
  std::vector<CheckFinding> findings_;
};

}  // namespace

std::vector<CheckFinding> CheckScene(const Scene& scene) { return Checker(scene).Run(); }

}  // namespace pregrasp
