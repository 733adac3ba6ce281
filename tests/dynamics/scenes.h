#pragma once

#include <cmath>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "app/core/math.h"
#include "app/core/rng.h"
#include "app/dynamics/world.h"
#include "app/geometry/hull.h"
#include "app/geometry/mass_properties.h"
#include "app/scene/scene.h"
#include "tests/geometry/test_shapes.h"

namespace pregrasp {

/// The finger that most tests push with.
inline constexpr int kIndex = static_cast<int>(Finger::kIndex);

// Scenes that the tests of app/dynamics share, built in code: SI units.

inline constexpr double kGravity = 9.81;

inline RigidTransform At(double x, double y, double z, const Vector3& rpy_deg = Vector3::Zero()) {
  return MakeTransform(RotationFromRpy(rpy_deg * (kPi / 180.0)), Vector3(x, y, z));
}

inline Body MakeFixed(const std::string& name, const Shape& shape, const RigidTransform& X_WB,
                      double friction) {
  Body body;
  body.name = name;
  body.shape = shape;
  body.X_WB = X_WB;
  body.friction = friction;
  return body;
}

/// A body of uniform density.
inline Body MakeMovable(const std::string& name, const Shape& shape, const RigidTransform& X_WB,
                        double mass, double friction) {
  Body body = MakeFixed(name, shape, X_WB, friction);
  body.mass_properties = CalcMassProperties(shape, mass);
  return body;
}

inline Body MakeBox(const std::string& name, const Vector3& size, const RigidTransform& X_WB,
                    double mass, double friction) {
  return MakeMovable(name, Box{size}, X_WB, mass, friction);
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
  return kGravity * Vector3(std::sin(angle), 0.0, -std::cos(angle));
}

inline void Simulate(const World& world, double seconds, WorldState* state) {
  const int steps = static_cast<int>(std::lround(seconds / world.config().dt));
  for (int i = 0; i < steps; ++i) world.Step(*state);
}

/// The angle between a body's z axis and W's [rad].
inline double CalcTilt(const BodyState& body) {
  return RotationAngle(
      Quaternion::FromTwoVectors(body.q_WB * Vector3::UnitZ(), Vector3::UnitZ()).toRotationMatrix(),
      Matrix3::Identity());
}

/// Every number of a state, bit by bit.
inline std::string BytesOf(const WorldState& state) {
  std::string bytes;
  const auto add = [&bytes](const void* data, std::size_t size) {
    bytes.append(static_cast<const char*>(data), size);
  };
  add(&state.step, sizeof(state.step));
  add(&state.t, sizeof(state.t));
  for (const BodyState& body : state.bodies) {
    add(body.q_WB.coeffs().data(), 4 * sizeof(double));
    for (const Vector3* v : {&body.p_WB, &body.w_WB, &body.v_WB}) add(v->data(), sizeof(Vector3));
  }
  for (const FingertipState& finger : state.fingers) {
    for (const Vector3* v :
         {&finger.p_OC, &finger.nhat_O, &finger.p_WF, &finger.p_WTarget, &finger.f_W}) {
      add(v->data(), sizeof(Vector3));
    }
    bytes += {static_cast<char>(finger.on), static_cast<char>(finger.touching),
              static_cast<char>(finger.slipping)};
    for (const double* x : {&finger.slip, &finger.stiffness, &finger.damping}) add(x, sizeof(*x));
  }
  for (const WorldState::CachedImpulse& impulse : state.cache) {
    add(&impulse.key, sizeof(impulse.key));
    add(impulse.impulse_W.data(), sizeof(Vector3));
  }
  return bytes;
}

/// A random convex polyhedron with `count` corners on an ellipsoid.
inline Shape MakeRandomHull(Rng& rng, int count, const Vector3& half) {
  MatrixX3 P(count, 3);
  for (int i = 0; i < count; ++i) P.row(i) = rng.Direction().cwiseProduct(half).transpose();
  return testing::MakeMesh(CalcConvexHull(P));
}

/// A box of 72 x 164 x 213 mm whose bottom is a crowd of corners within 2 `bump` [m] of z = 0: 30
/// to 60, of which the hull keeps those that show.
inline Shape MakeBumpyBox(std::uint64_t seed, double bump) {
  Rng rng(seed);
  const Vector3 half(0.036, 0.082, 0.1065);
  const int count = 30 + static_cast<int>(30.0 * rng.Uniform());
  MatrixX3 P(count + 4, 3);
  for (int i = 0; i < count; ++i) {
    const double x = rng.Uniform(-1.0, 1.0), y = rng.Uniform(-1.0, 1.0);
    // Slightly hollow upwards, so that most corners are on the hull.
    const double z = bump * (0.75 * (x * x + y * y) + rng.Uniform(0.0, 0.5));
    P.row(i) << half.x() * x, half.y() * y, z;
  }
  for (int i = 0; i < 4; ++i) {
    P.row(count + i) << (i % 2 == 0 ? -half.x() : half.x()), (i < 2 ? -half.y() : half.y()),
        2.0 * half.z();
  }
  return testing::MakeMesh(CalcConvexHull(P));
}

/// A bent bar with a knob, whose hull is far from it.
inline Union MakeHook() {
  Union hook;
  hook.parts.push_back({Box{Vector3(0.1, 0.02, 0.02)}, RigidTransform::Identity()});
  hook.parts.push_back({Box{Vector3(0.02, 0.02, 0.1)}, At(0.04, 0.0, 0.04)});
  hook.parts.push_back({Sphere{0.02}, At(-0.04, 0.0, 0.0)});
  return hook;
}

/// A dinner plate as its foot and its rim.
inline Union MakePlateUnion() {
  Union plate;
  plate.parts.push_back({Cylinder{0.075, 0.018}, At(0.0, 0.0, 0.009)});
  plate.parts.push_back({Cylinder{0.13, 0.007}, At(0.0, 0.0, 0.0215)});
  return plate;
}

}  // namespace pregrasp
