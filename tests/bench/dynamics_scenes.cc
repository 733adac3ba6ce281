#include "tests/bench/dynamics_scenes.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <utility>

#include "app/geometry/mass_properties.h"
#include "app/geometry/signed_distance.h"

namespace pregrasp {
namespace {

constexpr double kGravity = 9.81;

Body Fixed(const std::string& name, const Shape& shape, const RigidTransform& X_WB) {
  Body body;
  body.name = name;
  body.shape = shape;
  body.X_WB = X_WB;
  return body;
}

Body Movable(const std::string& name, const Shape& shape, const RigidTransform& X_WB, double mass) {
  Body body = Fixed(name, shape, X_WB);
  body.mass_properties = CalcMassProperties(shape, mass);
  return body;
}

RigidTransform At(double x, double y, double z, double pitch_deg = 0.0) {
  return MakeTransform(RotationFromRpy(Vector3(0.0, DegToRad(pitch_deg), 0.0)), Vector3(x, y, z));
}

DynamicsCase MakeCase(const std::string& name, double friction, double stiffness, Body object,
                      std::vector<Body> environment = {}) {
  DynamicsCase c;
  c.name = name;
  c.scene.name = name;
  c.scene.bodies.push_back(std::move(object));
  c.scene.bodies.push_back(Fixed("table", Box{Vector3(2.0, 2.0, 0.1)}, At(0.0, 0.0, -0.05)));
  for (Body& body : environment) c.scene.bodies.push_back(std::move(body));
  for (Body& body : c.scene.bodies) body.friction = friction;
  c.scene.fingertips.stiffness = stiffness;
  return c;
}

void SetFinger(const Vector3& p_OC, const Vector3& press, const Vector3& travel, DynamicsCase* c) {
  c->finger = true;
  c->p_OC = p_OC;
  c->press = press;
  c->travel = travel;
}

// The object is pushed or dragged along x and comes to rest where its spring balances friction.
void ExpectDrag(double friction_force, DynamicsCase* c) {
  c->quantity = "drag_mm";
  c->expected = 1e3 * (c->travel.x() - friction_force / c->scene.fingertips.stiffness);
  c->tolerance = 0.2 * c->expected;
  const double x0 = c->scene.object().X_WB.translation().x();
  c->measure = [x0](const RigidTransform& X_WO) { return 1e3 * (X_WO.translation().x() - x0); };
}

DynamicsCase MakeRest() {
  DynamicsCase c = MakeCase("rest", 0.5, 50.0,
                            Movable("box", Box{Vector3(0.1, 0.08, 0.06)}, At(0, 0, 0.03), 0.3));
  c.quantity = "moved_mm";
  c.tolerance = 1.0;
  c.measure = [](const RigidTransform& X_WO) {
    return 1e3 * (X_WO.translation() - Vector3(0, 0, 0.03)).norm();
  };
  return c;
}

// A book leans on a wall at 60 degrees; a fingertip pushes its foot until it stands.
DynamicsCase MakePivot() {
  const double s = std::sin(DegToRad(30.0)), k = std::cos(DegToRad(30.0));
  const Vector3 half(0.015, 0.075, 0.1);
  DynamicsCase c = MakeCase(
      "pivot", 0.4, 200.0,
      Movable("book", Box{2.0 * half},
              At(k * half.x() + s * half.z(), 0.0, s * half.x() + k * half.z(), -30.0), 0.5),
      {Fixed("wall", Box{Vector3(0.1, 1.0, 1.0)}, At(-0.05, 0.0, 0.5))});
  SetFinger(Vector3(0.015, 0.0, -0.085), Vector3::Zero(), Vector3(-0.11, 0.0, 0.0), &c);
  c.quantity = "tilt_deg";
  c.tolerance = 2.0;
  c.measure = [](const RigidTransform& X_WO) {
    return RadToDeg(std::acos(std::clamp(X_WO.linear()(2, 2), -1.0, 1.0)));
  };
  return c;
}

// A book between its neighbours; a fingertip presses on its top and draws it out. shelf5: two
// neighbours on either side can move.
DynamicsCase MakeShelf(const std::string& name, int movable_neighbours) {
  const Box book{Vector3(0.15, 0.03, 0.2)};
  const double mass = 0.8, mu = 0.3, pitch = 0.0305;
  std::vector<Body> environment;
  for (int side : {-1, 1}) {
    for (int i = 1; i <= movable_neighbours / 2 + 1; ++i) {
      const std::string id = (side < 0 ? "l" : "r") + std::to_string(i);
      const RigidTransform X_WB = At(0.0, side * i * pitch, 0.1);
      environment.push_back(i <= movable_neighbours / 2 ? Movable(id, book, X_WB, mass)
                                                        : Fixed(id, book, X_WB));
    }
  }
  DynamicsCase c =
      MakeCase(name, mu, 500.0, Movable("book", book, At(0, 0, 0.1), mass), std::move(environment));
  const double press = 6.0;
  SetFinger(Vector3(-0.05, 0.0, 0.1), Vector3(0.0, 0.0, -press / 500.0), Vector3(0.03, 0.0, 0.0),
            &c);
  ExpectDrag(mu * (mass * kGravity + press), &c);
  return c;
}

// A row of four boxes with one more on the second; a fingertip pushes the first.
DynamicsCase MakePush4() {
  const Box box{Vector3(0.1, 0.1, 0.1)};
  const double mass = 0.3, mu = 0.4;
  std::vector<Body> environment;
  for (int i = 1; i <= 3; ++i) {
    environment.push_back(Movable("b" + std::to_string(i), box, At(0.105 * i, 0, 0.05), mass));
  }
  environment.push_back(Movable("top", box, At(0.105, 0, 0.15), mass));
  DynamicsCase c = MakeCase("push4", mu, 300.0, Movable("box", box, At(0, 0, 0.05), mass),
                            std::move(environment));
  SetFinger(Vector3(-0.05, 0.0, -0.02), Vector3::Zero(), Vector3(0.1, 0.0, 0.0), &c);
  ExpectDrag(mu * 5.0 * mass * kGravity, &c);
  return c;
}

// A plate on its foot; a fingertip under the rim lifts one side.
DynamicsCase MakePlate() {
  const double foot = 0.075, rim = 0.13, grip = 0.11, under = 0.018, mass = 0.55, k = 200.0;
  Union plate;
  plate.parts.push_back({Cylinder{foot, under}, At(0, 0, 0.5 * under)});
  plate.parts.push_back({Cylinder{rim, 0.007}, At(0, 0, under + 0.0035)});
  DynamicsCase c = MakeCase("plate", 0.3, k, Movable("plate", plate, At(0, 0, 0), mass));
  const double rise = 0.03;
  SetFinger(Vector3(grip, 0.0, under), Vector3(0.0, 0.0, rise), Vector3::Zero(), &c);
  c.quantity = "lift_mm";
  c.expected = 1e3 * (rise - mass * kGravity * foot / (foot + grip) / k);
  c.tolerance = 0.2 * c.expected;
  c.measure = [=](const RigidTransform& X_WO) {
    return 1e3 * ((X_WO * Vector3(grip, 0.0, under)).z() - under);
  };
  return c;
}

DynamicsCase MakeCylinder() {
  const double mass = 0.53, mu = 0.3, k = 200.0;
  DynamicsCase c =
      MakeCase("cylinder", mu, k, Movable("bottle", Cylinder{0.033, 0.2}, At(0, 0, 0.1), mass));
  SetFinger(Vector3(-0.033, 0.0, -0.05), Vector3::Zero(), Vector3(0.1, 0.0, 0.0), &c);
  ExpectDrag(mu * mass * kGravity, &c);
  return c;
}

// A tapered container with rounded corners: the hull of two rings of 16 points.
DynamicsCase MakeMesh() {
  constexpr int kRing = 16;
  Mesh mesh;
  mesh.mesh.V.resize(2 * kRing, 3);
  mesh.mesh.F.resize(4 * kRing - 4, 3);
  for (int ring = 0; ring < 2; ++ring) {
    for (int i = 0; i < kRing; ++i) {
      const double angle = 2.0 * kPi * (i + 0.5) / kRing;
      const Vector2 half = ring == 0 ? Vector2(0.085, 0.065) : Vector2(0.1, 0.08);
      const auto squircle = [](double x) { return std::copysign(std::sqrt(std::abs(x)), x); };
      mesh.mesh.V.row(ring * kRing + i) << half.x() * squircle(std::cos(angle)),
          half.y() * squircle(std::sin(angle)), ring * 0.07;
    }
  }
  int f = 0;
  for (int i = 0; i < kRing; ++i) {
    const int j = (i + 1) % kRing;
    mesh.mesh.F.row(f++) << i, j, kRing + j;
    mesh.mesh.F.row(f++) << i, kRing + j, kRing + i;
  }
  for (int i = 1; i + 1 < kRing; ++i) {
    mesh.mesh.F.row(f++) << 0, i + 1, i;
    mesh.mesh.F.row(f++) << kRing, kRing + i, kRing + i + 1;
  }
  const double mass = 0.5, mu = 0.3, k = 200.0;
  DynamicsCase c = MakeCase("mesh", mu, k, Movable("container", mesh, At(0, 0, 0), mass));
  SetFinger(Vector3(-0.095, 0.0, 0.03), Vector3::Zero(), Vector3(0.08, 0.0, 0.0), &c);
  ExpectDrag(mu * mass * kGravity, &c);
  return c;
}

}  // namespace

std::vector<DynamicsCase> MakeDynamicsCases() {
  return {MakeRest(),  MakePivot(), MakeShelf("slot", 0), MakeShelf("shelf5", 4),
          MakePush4(), MakePlate(), MakeCylinder(),       MakeMesh()};
}

double ThreadCpuSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

Vector3 FingerNormal(const DynamicsCase& c) {
  Vector3 nhat_O;
  SignedDistance(c.scene.object().shape).Project(c.p_OC, &nhat_O);
  return nhat_O;
}

Vector3 CalcPeerFingerForce(const DynamicsCase& c, const Vector3& p_WTarget, const Vector3& p_WC,
                            const Vector3& v_WC, const Vector3& nhat_W) {
  const FingertipConfig& tip = c.scene.fingertips;
  const double damping =
      tip.damping * std::sqrt(tip.stiffness * c.scene.object().mass_properties->mass);
  const Vector3 f = tip.stiffness * (p_WTarget - p_WC) - damping * v_WC;
  const double normal = std::max(0.0, -f.dot(nhat_W));
  Vector3 tangential = f - nhat_W * f.dot(nhat_W);
  const double limit = tip.friction * normal;
  if (tangential.norm() > limit) tangential *= limit / tangential.norm();
  Vector3 force = tangential - normal * nhat_W;
  if (force.norm() > tip.max_force) force *= tip.max_force / force.norm();
  return force;
}

}  // namespace pregrasp
