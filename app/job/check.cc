#include "app/job/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "app/dynamics/world.h"
#include "app/geometry/cloud_doubts.h"
#include "app/geometry/hull.h"
#include "app/geometry/mass_properties.h"
#include "app/geometry/overlap.h"
#include "app/geometry/tessellate.h"
#include "app/job/motion_measure.h"
#include "app/scene/shape_visit.h"

namespace pregrasp {
namespace {

using Severity = CheckFinding::Severity;

constexpr double kLargeObject = 2.0, kSmallObject = 0.002;  // [m], longest edge of its box
constexpr double kWidePieces = 1e-3;  // [m], how far pieces may reach outside their shape
constexpr double kLightest = 20.0, kHeaviest = 20000.0;  // [kg/m^3]: foam, osmium
constexpr double kNear = 1e-4;  // [m]; what has nothing so near below it floats
// [m]; what the contact solver left undone by the end of the test for rest, a tenth of what it
// allows, is no longer a matter of digits.
constexpr double kUnresolved = 0.1 * kRestMoved;

class Checker {
 public:
  explicit Checker(const Scene& scene) : scene_(scene) {}

  std::vector<CheckFinding> Run() {
    CheckOverlaps();
    if (findings_.empty()) CheckRest();  // what overlaps is pushed apart and never at rest
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) CheckUnits(scene_.bodies[i], i == 0);
    for (const Body& body : scene_.bodies) {
      CheckPieces(body);
      CheckClouds(body);
    }
    for (const std::string& departure : RuleDepartures(scene_)) {
      Add(Severity::kWarning, WhereOf(departure),
          departure + ": the results count as outside the rules");
    }
    for (CheckFinding& repair : ListRepairs(scene_)) findings_.push_back(std::move(repair));
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
    const SettleResult settled = Settle(world, state, kRestSeconds);
    if (settled.not_converged > 0) {
      Add(settled.unresolved > kUnresolved ? Severity::kWarning : Severity::kNote, WhereOf(""),
          fmt::format("the contact forces of {} of {} physics steps were not found to the solver's "
                      "tolerance; bodies may sink into each other by {:.2g} mm in {:g} s",
                      settled.not_converged, settled.steps, 1e3 * settled.unresolved,
                      kRestSeconds));
    }
    if (settled.at_rest) return;
    const auto body =
        std::find_if(scene_.bodies.begin(), scene_.bodies.end(),
                     [&](const Body& candidate) { return candidate.name == settled.largest.body; });
    Add(Severity::kError, body->where,
        fmt::format(
            "\"{}\" is not at rest: within {:g} s it moves {:.2f} mm, and something turns by "
            "{:.2f} deg (allowed: {:g} mm and {:g} deg){}",
            body->name, kRestSeconds, 1e3 * settled.largest.moved,
            RadToDeg(settled.largest.rotated), 1e3 * kRestMoved, RadToDeg(kRestRotated),
            IsFloating(*body)
                ? fmt::format("; it floats, as nothing is below it within {:g} mm", 1e3 * kNear)
                : ""));
  }

  // Whether no other body comes near it at the start.
  bool IsFloating(const Body& body) const {
    Scene grown = scene_;
    const auto index = static_cast<std::size_t>(&body - scene_.bodies.data());
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
          fmt::format("\"{}\" is {:.3g} m long; a hand handles {:g} mm to {:g} m (are its sizes "
                      "in metres?)",
                      body.name, longest, 1e3 * kSmallObject, kLargeObject));
    }
    if (!body.movable()) return;
    const double mass = body.mass_properties->mass;
    const double density = mass / std::max(1e-12, CalcVolume(body.shape));
    if (density < kLightest || density > kHeaviest) {
      Add(Severity::kWarning, body.where,
          fmt::format(
              "\"{}\" has {:.3g} kg/m^3 ({:.3g} kg); usual are {:g} to {:g} (is its mass in "
              "kg, are its sizes in metres?)",
              body.name, density, mass, kLightest, kHeaviest));
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

  // A side without points was closed over, and may be anything.
  void CheckClouds(const Body& body) {
    ForEachLeaf(body.shape, RigidTransform::Identity(), [&](const Shape& leaf, const auto& X_BP) {
      const auto* cloud = std::get_if<Cloud>(&leaf);
      if (cloud == nullptr) return;
      const CloudDoubts doubts = FindCloudDoubts(cloud->points);
      if (!doubts.has_rim()) return;
      const Vector3 p_B = X_BP * doubts.p_rim;
      Add(Severity::kWarning, body.where,
          fmt::format("the points of \"{}\" end along a rim, {} of them, one at ({:.3g}, {:.3g}, "
                      "{:.3g}) m in its frame: the surface beyond has no points and was made up",
                      body.name, doubts.rim_points, p_B.x(), p_B.y(), p_B.z()));
    });
  }

  const Scene& scene_;
  std::vector<CheckFinding> findings_;
};

}  // namespace

std::vector<CheckFinding> ListRepairs(const Scene& scene) {
  std::vector<CheckFinding> repairs;
  for (const Body& body : scene.bodies) {
    std::set<std::string> told;  // the parts of one file say the same
    ForEachLeaf(body.shape, RigidTransform::Identity(), [&](const Shape& leaf, const auto&) {
      const auto* mesh = std::get_if<Mesh>(&leaf);
      if (mesh == nullptr || mesh->repaired.empty() || !told.insert(mesh->file).second) return;
      repairs.push_back({Severity::kNote, body.where,
                         fmt::format("\"{}\" was repaired: {}", mesh->file, mesh->repaired)});
    });
  }
  return repairs;
}

std::vector<CheckFinding> CheckScene(const Scene& scene) { return Checker(scene).Run(); }

}  // namespace pregrasp
