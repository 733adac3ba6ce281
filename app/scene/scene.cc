#include "app/scene/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "app/core/error.h"
#include "app/core/text.h"

namespace pregrasp {
namespace {

constexpr double kMaxSize = 100.0;  // [m]; a larger number is a unit error

void RequirePositive(const std::string& where, const std::string& field, double value) {
  if (!(std::isfinite(value) && value > 0.0)) {
    throw InputError(where, field, "a number above 0", FormatDouble(value));
  }
}

void RequireLength(const std::string& where, const std::string& field, double value) {
  if (!(std::isfinite(value) && value > 0.0 && value <= kMaxSize)) {
    throw InputError(where, field, "a length above 0 and at most 100 m", FormatDouble(value));
  }
}

void RequireFinite(const std::string& where, const std::string& field, const Vector3& v) {
  for (int i = 0; i < 3; ++i) {
    if (!std::isfinite(v[i])) {
      throw InputError(where, field, "three finite numbers", FormatDouble(v[i]));
    }
  }
}

struct ShapeValidator {
  const std::string& where;
  const std::string& field;

  void operator()(const Box& box) const {
    for (int i = 0; i < 3; ++i) RequireLength(where, field, box.size[i]);
  }
  void operator()(const Cylinder& cylinder) const {
    RequireLength(where, field + ".r", cylinder.radius);
    RequireLength(where, field + ".h", cylinder.height);
  }
  void operator()(const Capsule& capsule) const {
    RequireLength(where, field + ".r", capsule.radius);
    RequireLength(where, field + ".h", capsule.height);
  }
  void operator()(const Sphere& sphere) const { RequireLength(where, field + ".r", sphere.radius); }
  void operator()(const Mesh& mesh) const { RequirePositive(where, field + ".scale", mesh.scale); }
  void operator()(const Cloud& cloud) const {
    RequirePositive(where, field + ".scale", cloud.scale);
  }
  void operator()(const Union& whole) const {
    if (whole.parts.empty()) throw InputError(where, field, "at least one part", "an empty union");
    for (std::size_t i = 0; i < whole.parts.size(); ++i) {
      const std::string part = fmt::format("{}[{}]", field, i + 1);
      RequireFinite(where, part + ".p", whole.parts[i].X_BP.translation());
      std::visit(ShapeValidator{where, part}, whole.parts[i].shape);
    }
  }
};

void ValidateName(const std::string& where, const std::string& field, const std::string& name) {
  const bool legal = !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) || c == '_' || c == '-';
  });
  if (!legal)
    throw InputError(where, field, "a name of letters, digits, _ and -", '"' + name + '"');
}

void ValidateMass(const Body& body, const std::string& field) {
  const MassProperties& mass = *body.mass_properties;
  RequirePositive(body.where, field + ".mass", mass.mass);
  RequireFinite(body.where, field + ".com", mass.p_BoBcm);
}

void ValidateBody(const Body& body, const std::string& field) {
  ValidateName(body.where, field + ".name", body.name);
  RequireFinite(body.where, field + ".p", body.X_WB.translation());
  if (!body.X_WB.linear().allFinite()) {
    throw InputError(body.where, field + ".rpy_deg", "three finite numbers", "nan");
  }
  const std::string shape_field = field + ".shape";
  std::visit(ShapeValidator{body.where, shape_field}, body.shape);
  if (!(std::isfinite(body.friction) && body.friction >= 0.0 && body.friction <= 10.0)) {
    throw InputError(body.where, field + ".friction", "a coefficient from 0 to 10",
                     FormatDouble(body.friction));
  }
  if (body.movable()) ValidateMass(body, field);
}

}  // namespace

const char* ShapeKind(const Shape& shape) {
  constexpr const char* kKinds[] = {"box",  "cylinder", "capsule", "sphere",
                                    "mesh", "cloud",    "union"};
  return kKinds[shape.index()];
}

void ValidateScene(const Scene& scene) {
  ValidateName(scene.file, "name", scene.name);
  if (scene.bodies.empty()) throw InputError(scene.file, "object", "an object", "none");
  if (!scene.object().movable()) {
    throw InputError(scene.object().where, "object.mass", "a mass above 0 kg", "none");
  }
  if (scene.bodies.size() < 2) {
    throw InputError(scene.file, "environment", "at least one body", "none");
  }
  std::set<std::string> names;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    const std::string field = i == 0 ? "object" : fmt::format("environment[{}]", i);
    ValidateBody(body, field);
    if (!names.insert(body.name).second) {
      throw InputError(body.where, field + ".name", "a name no other body has",
                       '"' + body.name + '"');
    }
  }
  RequireFinite(scene.file, "gravity", scene.gravity);
  const FingertipConfig& tips = scene.fingertips;
  if (!(std::isfinite(tips.friction) && tips.friction >= 0.0 && tips.friction <= 10.0)) {
    throw InputError(scene.file, "fingertips.friction", "a coefficient from 0 to 10",
                     FormatDouble(tips.friction));
  }
  RequirePositive(scene.file, "fingertips.max_force", tips.max_force);
  RequirePositive(scene.file, "fingertips.stiffness", tips.stiffness);
  if (!(std::isfinite(tips.damping) && tips.damping >= 0.0)) {
    throw InputError(scene.file, "fingertips.damping", "a number of at least 0",
                     FormatDouble(tips.damping));
  }
}

std::vector<std::string> RuleDepartures(const Scene& scene) {
  std::vector<std::string> departures;
  if (scene.fingertips.friction > 1.0) {
    departures.push_back(
        fmt::format("fingertips.friction {} is above 1.0", scene.fingertips.friction));
  }
  if (scene.fingertips.max_force > 15.0) {
    departures.push_back(
        fmt::format("fingertips.max_force {} N is above 15 N", scene.fingertips.max_force));
  }
  if ((scene.gravity - Vector3(0.0, 0.0, -9.81)).norm() > 1e-12) {
    departures.push_back(fmt::format("gravity is ({}, {}, {}) instead of (0, 0, -9.81) m/s^2",
                                     scene.gravity.x(), scene.gravity.y(), scene.gravity.z()));
  }
  for (const Body& body : scene.bodies) {
    if (body.friction < 0.2 || body.friction > 0.6) {
      departures.push_back(
          fmt::format("friction {} of \"{}\" is outside 0.2 to 0.6", body.friction, body.name));
    }
  }
  return departures;
}

}  // namespace pregrasp
