#include "app/scene/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "app/core/error.h"
#include "app/core/text.h"

namespace pregrasp {
namespace {

constexpr double kMaxSize = 100.0;       // [m]; a larger number is a unit error
constexpr double kMaxDistance = 1000.0;  // [m], from the world's origin
constexpr double kMaxMass = 1e6;         // [kg]

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

void RequirePoint(const std::string& where, const std::string& field, const Vector3& p) {
  for (int i = 0; i < 3; ++i) {
    if (!(std::abs(p[i]) <= kMaxDistance)) {
      throw InputError(where, field, "three numbers within 1000 m", FormatDouble(p[i]));
    }
  }
}

void RequireFriction(const std::string& where, const std::string& field, double friction) {
  if (!(std::isfinite(friction) && friction >= 0.0 && friction <= 10.0)) {
    throw InputError(where, field, "a coefficient from 0 to 10", FormatDouble(friction));
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
      RequirePoint(where, part + ".p", whole.parts[i].X_BP.translation());
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

// An inertia that a rigid body can have: positive moments, none above the sum of the others. Zero
// stands for "not given".
void ValidateInertia(const Body& body, const std::string& field) {
  const Matrix3& I = body.mass_properties->I_BBcm;
  if (I.isZero(0.0)) return;
  const std::string expected = "the inertia of a rigid body in kg m^2";
  if (!I.allFinite()) throw InputError(body.where, field, expected, "a number that is not finite");
  const Vector3 moments =
      Eigen::SelfAdjointEigenSolver<Matrix3>(I, Eigen::EigenvaluesOnly).eigenvalues();
  if (moments[0] <= 0.0 || moments[2] > (1.0 + 1e-9) * (moments[0] + moments[1])) {
    throw InputError(body.where, field, expected,
                     fmt::format("principal moments {}, {} and {}", FormatDouble(moments[0]),
                                 FormatDouble(moments[1]), FormatDouble(moments[2])));
  }
}

void ValidateMass(const Body& body, const std::string& field) {
  const MassProperties& properties = *body.mass_properties;
  if (!(properties.mass > 0.0 && properties.mass <= kMaxMass)) {
    throw InputError(body.where, field + ".mass",
                     properties.mass > 0.0 ? "a mass of at most 1e6 kg" : "a mass above 0 kg",
                     FormatDouble(properties.mass));
  }
  RequirePoint(body.where, field + ".com", properties.p_BoBcm);
  ValidateInertia(body, field + ".inertia");
}

void ValidateBody(const Body& body, const std::string& field) {
  ValidateName(body.where, field + ".name", body.name);
  RequirePoint(body.where, field + ".p", body.X_WB.translation());
  if (!body.X_WB.linear().allFinite()) {
    throw InputError(body.where, field + ".rpy_deg", "three finite numbers", "nan");
  }
  const std::string shape_field = field + ".shape";
  std::visit(ShapeValidator{body.where, shape_field}, body.shape);
  RequireFriction(body.where, field + ".friction", body.friction);
  if (body.movable()) ValidateMass(body, field);
}

void ValidateFingertips(const std::string& where, const FingertipConfig& tips) {
  RequireFriction(where, "fingertips.friction", tips.friction);
  RequirePositive(where, "fingertips.max_force", tips.max_force);
  RequirePositive(where, "fingertips.stiffness", tips.stiffness);
  RequirePositive(where, "fingertips.grasp_stiffness", tips.grasp_stiffness);
  if (!(std::isfinite(tips.damping) && tips.damping >= 0.0)) {
    throw InputError(where, "fingertips.damping", "a number of at least 0",
                     FormatDouble(tips.damping));
  }
}

void ValidateCamera(const std::string& where, const CameraConfig& camera) {
  RequirePoint(where, "camera.p", camera.p_WCam);
  RequirePoint(where, "camera.look_at", camera.p_WTarget);
  if ((camera.p_WCam - camera.p_WTarget).norm() < 1e-6) {
    throw InputError(where, "camera.look_at", "a point other than camera.p", "the same");
  }
  if (!(camera.fov_deg >= 1.0 && camera.fov_deg <= 150.0)) {
    throw InputError(where, "camera.fov_deg", "an angle from 1 to 150 degrees",
                     FormatDouble(camera.fov_deg));
  }
}

}  // namespace

const char* ShapeKind(const Shape& shape) {
  constexpr const char* kKinds[] = {"box",  "cylinder", "capsule", "sphere",
                                    "mesh", "cloud",    "union"};
  return kKinds[shape.index()];
}

void ValidateScene(const Scene& scene) {
  const std::string& where = scene.where.empty() ? scene.file : scene.where;
  ValidateName(where, "name", scene.name);
  if (scene.bodies.empty()) throw InputError(where, "object", "an object", "none");
  if (!scene.object().movable()) {
    throw InputError(scene.object().where, "object.mass", "a mass above 0 kg", "none");
  }
  if (scene.bodies.size() < 2) {
    throw InputError(where, "environment", "at least one body", "none");
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
  for (int i = 0; i < 3; ++i) {
    if (!(std::abs(scene.gravity[i]) <= 100.0)) {
      throw InputError(where, "gravity", "three numbers within 100 m/s^2",
                       FormatDouble(scene.gravity[i]));
    }
  }
  ValidateFingertips(where, scene.fingertips);
  if (scene.camera) ValidateCamera(where, *scene.camera);
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
  if (!(scene.fingertips.grasp_stiffness >= 150.0 && scene.fingertips.grasp_stiffness <= 600.0)) {
    departures.push_back(fmt::format("fingertips.grasp_stiffness {} N/m is outside 150 to 600 N/m",
                                     scene.fingertips.grasp_stiffness));
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
