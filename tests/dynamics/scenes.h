#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "app/core/math.h"
#include "app/dynamics/world.h"
#include "app/scene/scene.h"

namespace pregrasp {

// Scenes that the tests of app/dynamics share, built in code: SI units.

inline Body MakeFixed(const std::string& name, const Shape& shape, const RigidTransform& X_WB,
                      double friction) {
  Body body;
  body.name = name;
  body.shape = shape;
  body.X_WB = X_WB;
  body.friction = friction;
  return body;
}

/// The inertia of a solid box of edge lengths `size`.
inline Matrix3 BoxInertia(double mass, const Vector3& size) {
  const Vector3 s2 = size.cwiseProduct(size);
  return (mass / 12.0 * Vector3(s2.y() + s2.z(), s2.x() + s2.z(), s2.x() + s2.y())).asDiagonal();
}

inline Body MakeMovable(const std::string& name, const Shape& shape, const RigidTransform& X_WB,
                        double mass, double friction, const Matrix3& I_BBcm,
                        const Vector3& p_BoBcm = Vector3::Zero()) {
  Body body = MakeFixed(name, shape, X_WB, friction);
  body.mass_properties = MassProperties{mass, p_BoBcm, I_BBcm};
  return body;
}

inline Body MakeBox(const std::string& name, const Vector3& size, const RigidTransform& X_WB,
                    double mass, double friction) {
  return MakeMovable(name, Box{size}, X_WB, mass, friction, BoxInertia(mass, size));
}

inline RigidTransform At(double x, double y, double z, const Vector3& rpy_deg = Vector3::Zero()) {
  return MakeTransform(RotationFromRpy(rpy_deg * (kPi / 180.0)), Vector3(x, y, z));
}

/// A table whose top is z = 0, 2 m wide.
inline Body MakeTable(double friction = 0.5) {
  return MakeFixed("table", Box{Vector3(2.0, 2.0, 0.1)}, At(0.0, 0.0, -0.05), friction);
}

/// `object` and what surrounds it, by default a table.
inline Scene MakeScene(const Body& object, std::vector<Body> environment = {MakeTable()}) {
  Scene scene;
  scene.name = "test";
  scene.bodies.push_back(object);
  for (Body& body : environment) scene.bodies.push_back(std::move(body));
  return scene;
}

/// Gravity as on an incline of `angle` [rad] whose surface is the table: down the slope is +x.
inline Vector3 InclineGravity(double angle) {
  return 9.81 * Vector3(std::sin(angle), 0.0, -std::cos(angle));
}

inline void Simulate(const World& world, double seconds, WorldState* state) {
  const int steps = static_cast<int>(std::lround(seconds / world.config().dt));
  for (int i = 0; i < steps; ++i) world.Step(*state);
}

}  // namespace pregrasp
