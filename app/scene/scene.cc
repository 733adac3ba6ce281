#include "app/scene/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "app/core/error.h"
#include "app/core/text.h"
#include "app/scene/limits.h"

namespace pregrasp {
namespace {

// Each of the three within the range.
void RequireEach(const std::string& where, const std::string& field, const NumberRange& range,
                 const Vector3& v) {
  for (int i = 0; i < 3; ++i) RequireWithin(where, field, range, v[i]);
}

struct ShapeValidator {
  const std::string& where;
  const std::string& field;

  void operator()(const Box& box) const { RequireEach(where, field, kLengthRange, box.size); }
  void operator()(const Cylinder& cylinder) const {
    RequireWithin(where, field + ".r", kLengthRange, cylinder.radius);
    RequireWithin(where, field + ".h", kLengthRange, cylinder.height);
  }
  void operator()(const Capsule& capsule) const {
    RequireWithin(where, field + ".r", kLengthRange, capsule.radius);
    RequireWithin(where, field + ".h", kLengthRange, capsule.height);
  }
  void operator()(const Sphere& sphere) const {
    RequireWithin(where, field + ".r", kLengthRange, sphere.radius);
  }
  void operator()(const Mesh& mesh) const {
    RequireWithin(where, field + ".scale", kScaleRange, mesh.scale);
  }
  void operator()(const Cloud& cloud) const {
    RequireWithin(where, field + ".scale", kScaleRange, cloud.scale);
  }
  void operator()(const Union& whole) const {
    if (whole.parts.empty()) throw InputError(where, field, "at least one part", "an empty union");
    for (std::size_t i = 0; i < whole.parts.size(); ++i) {
      const std::string part = fmt::format("{}[{}]", field, i + 1);
      RequireEach(where, part + ".p", kPositionRange, whole.parts[i].X_BP.translation());
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
  RequireWithin(body.where, field + ".mass", kMassRange, properties.mass);
  RequireEach(body.where, field + ".com", kPositionRange, properties.p_BoBcm);
  ValidateInertia(body, field + ".inertia");
}

void ValidateBody(const Body& body, const std::string& field) {
  ValidateName(body.where, field + ".name", body.name);
  RequireEach(body.where, field + ".p", kPositionRange, body.X_WB.translation());
  if (!body.X_WB.linear().allFinite()) {
    throw InputError(body.where, field + ".rpy_deg", "three finite numbers", "nan");
  }
  const std::string shape_field = field + ".shape";
  std::visit(ShapeValidator{body.where, shape_field}, body.shape);
  RequireWithin(body.where, field + ".friction", kFrictionRange, body.friction);
  if (body.movable()) ValidateMass(body, field);
}

void ValidateFingertips(const std::string& where, const FingertipConfig& tips) {
  RequireWithin(where, "fingertips.friction", kFrictionRange, tips.friction);
  RequireWithin(where, "fingertips.max_force", kForceRange, tips.max_force);
  RequireWithin(where, "fingertips.stiffness", kStiffnessRange, tips.stiffness);
  RequireWithin(where, "fingertips.grasp_stiffness", kStiffnessRange, tips.grasp_stiffness);
  RequireWithin(where, "fingertips.damping", kDampingRange, tips.damping);
}

void ValidateCamera(const std::string& where, const CameraConfig& camera) {
  RequireEach(where, "camera.p", kPositionRange, camera.p_WCam);
  RequireEach(where, "camera.look_at", kPositionRange, camera.p_WTarget);
  if ((camera.p_WCam - camera.p_WTarget).norm() < 1e-6) {
    throw InputError(where, "camera.look_at", "a point other than camera.p", "the same");
  }
  RequireWithin(where, "camera.fov_deg", kFovRange, camera.fov_deg);
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
    throw InputError(scene.object().where, "object.mass", kMassRange.Expected(), "none");
  }
  if (scene.bodies.size() < 2) {
    throw InputError(where, "environment", "at least one body", "none");
  }
  if (scene.bodies.size() > kMostBodies) {
    throw InputError(where, "environment", fmt::format("at most {} bodies", kMostBodies - 1),
                     std::to_string(scene.bodies.size() - 1));
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
  RequireEach(where, "gravity", kGravityRange, scene.gravity);
  ValidateFingertips(where, scene.fingertips);
  if (scene.camera) ValidateCamera(where, *scene.camera);
}

std::vector<std::string> RuleDepartures(const Scene& scene) {
  std::vector<std::string> departures;
  if (!(scene.fingertips.friction <= 1.0)) {
    departures.push_back(
        fmt::format("fingertips.friction {} is above 1.0", scene.fingertips.friction));
  }
  if (!(scene.fingertips.max_force <= 15.0)) {
    departures.push_back(
        fmt::format("fingertips.max_force {} N is above 15 N", scene.fingertips.max_force));
  }
  if (!(scene.fingertips.grasp_stiffness >= 150.0 && scene.fingertips.grasp_stiffness <= 600.0)) {
    departures.push_back(fmt::format("fingertips.grasp_stiffness {} N/m is outside 150 to 600 N/m",
                                     scene.fingertips.grasp_stiffness));
  }
  if (!((scene.gravity - Vector3(0.0, 0.0, -9.81)).norm() <= 1e-12)) {
    departures.push_back(fmt::format("gravity is ({}, {}, {}) instead of (0, 0, -9.81) m/s^2",
                                     scene.gravity.x(), scene.gravity.y(), scene.gravity.z()));
  }
  for (const Body& body : scene.bodies) {
    if (!(body.friction >= 0.2 && body.friction <= 0.6)) {
      departures.push_back(
          fmt::format("friction {} of \"{}\" is outside 0.2 to 0.6", body.friction, body.name));
    }
  }
  return departures;
}

}  // namespace pregrasp
