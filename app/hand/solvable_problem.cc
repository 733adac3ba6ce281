#include "app/hand/solvable_problem.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/geometry/signed_distance.h"

namespace pregrasp {
namespace {

// Angles between which a thumb is open, from its root: turn, opposition, two in the middle, last.
constexpr std::array<std::pair<double, double>, 5> kOpenThumb{
    {{-0.2, 1.0}, {0.0, 0.6}, {-0.1, 0.1}, {-0.4, 0.1}, {-0.2, 0.3}}};
constexpr double kTruthCone = 0.52;  // cosine at the truth, a little inside 60 degrees

RigidTransform Turned(double yaw, const Vector3& p) {
  return MakeTransform(RotationFromRpy({0.0, 0.0, yaw}), p);
}

// A disc whose rim rises outwards: a union of a flat cylinder and tilted slabs.
Shape MakePlate(Rng& rng, double* height) {
  constexpr int kSlabs = 20;
  const double radius = rng.Uniform(0.06, 0.10);
  const double thickness = rng.Uniform(0.004, 0.008);
  const double rim = rng.Uniform(0.02, 0.035);
  const double tilt = rng.Uniform(0.4, 0.9);
  Union plate;
  plate.parts.push_back({Cylinder{radius, thickness}, RigidTransform::Identity()});
  for (int i = 0; i < kSlabs; ++i) {
    const double yaw = 2.0 * kPi * i / kSlabs;
    const double reach = radius + 0.5 * rim * std::cos(tilt) - 0.002;
    const double width = 2.0 * (radius + rim) * std::tan(kPi / kSlabs) + 0.001;
    const RigidTransform X_BP = Turned(yaw, Vector3::Zero()) *
                                MakeTransform(RotationFromRpy({0.0, -tilt, 0.0}),
                                              Vector3(reach, 0.0, 0.5 * rim * std::sin(tilt)));
    plate.parts.push_back({Box{{rim, width, thickness}}, X_BP});
  }
  *height = 0.5 * thickness;
  return plate;
}

struct PlacedObject {
  Shape shape;
  RigidTransform X_WO;
  double radius;  // in the plane
};

PlacedObject MakeObject(IkObject kind, Rng& rng) {
  const double yaw = rng.Uniform(0.0, 2.0 * kPi);
  switch (kind) {
    case IkObject::kBox: {
      const Vector3 size(rng.Uniform(0.04, 0.18), rng.Uniform(0.04, 0.14), rng.Uniform(0.02, 0.10));
      return {Box{size}, Turned(yaw, {0.0, 0.0, 0.5 * size.z()}), 0.5 * size.head<2>().norm()};
    }
    case IkObject::kCylinder: {
      const Cylinder cylinder{rng.Uniform(0.02, 0.05), rng.Uniform(0.06, 0.18)};
      if (rng.Uniform() < 0.5) {
        return {cylinder, Turned(yaw, {0.0, 0.0, 0.5 * cylinder.height}), cylinder.radius};
      }
      const Matrix3 lying = RotationFromRpy({0.5 * kPi, 0.0, yaw});
      return {cylinder, MakeTransform(lying, Vector3(0.0, 0.0, cylinder.radius)),
              0.5 * cylinder.height};
    }
    case IkObject::kPlate: {
      double height = 0.0;
      Shape plate = MakePlate(rng, &height);
      return {plate, Turned(yaw, {0.0, 0.0, height}), 0.13};
    }
    default: {
      Mesh mesh;
      mesh.file = "bumpy";
      mesh.mesh = MakeBumpyMesh(rng.Uniform(0.06, 0.13), rng);
      const double low = mesh.mesh.V.col(2).minCoeff();
      return {mesh, Turned(yaw, {0.0, 0.0, -low}),
              mesh.mesh.V.leftCols<2>().rowwise().norm().maxCoeff()};
    }
  }
}

struct ShapeWorld {
  std::vector<Shape> shapes;
  std::vector<RigidTransform> X_WB;
};

ShapeWorld MakeShapeWorld(IkObject kind, bool clutter, Rng& rng) {
  PlacedObject object = MakeObject(kind, rng);
  ShapeWorld world{{std::move(object.shape), Box{{1.6, 1.6, 0.02}}},
                   {object.X_WO, Turned(0.0, {0.0, 0.0, -0.01})}};
  if (!clutter) return world;
  const double gap = rng.Uniform(0.005, 0.05);
  const double yaw = rng.Uniform(0.0, 2.0 * kPi);
  world.shapes.push_back(Box{{0.02, 0.6, 0.4}});
  world.X_WB.push_back(Turned(yaw, Vector3::Zero()) *
                       Turned(0.0, {object.radius + gap + 0.01, 0.0, 0.2}));
  for (int i = 0; i < 3; ++i) {
    const Vector3 size(rng.Uniform(0.03, 0.1), rng.Uniform(0.03, 0.1), rng.Uniform(0.04, 0.2));
    const double away = object.radius + 0.5 * size.head<2>().norm() + rng.Uniform(0.005, 0.12);
    const double around = yaw + rng.Uniform(0.3, 2.0 * kPi - 0.3);
    world.shapes.push_back(Box{size});
    world.X_WB.push_back(Turned(around, Vector3::Zero()) *
                         Turned(rng.Uniform(0.0, kPi), {away, 0.0, 0.5 * size.z()}));
  }
  return world;
}

// Postures between which fingers close.
HandJoints OpenPosture(const HandModel& hand, Rng& rng) {
  HandJoints q = HandJoints::Zero();
  for (int j = 0; j < hand.num_joints; ++j) {
    const double lower = hand.q_lower[j];
    const double upper = hand.q_upper[j];
    const bool sideways = lower < -0.3 && upper < 0.4;  // abduction
    q[j] = sideways ? 0.3 * rng.Uniform(lower, upper)
                    : lower + rng.Uniform(0.0, 0.3) * (upper - lower);
  }
  const auto [thumb, thumb_joints] = hand.fingers[0];
  for (int k = 0; k < std::min<int>(thumb_joints, kOpenThumb.size()); ++k) {
    q[thumb + k] = rng.Uniform(kOpenThumb[k].first, kOpenThumb[k].second);
  }
  for (int f = 1; f < hand.num_fingers; ++f) {
    const auto [first, count] = hand.fingers[f];
    if (count > 4) q[first] = rng.Uniform(0.0, 0.3);  // the palm's arch
  }
  return q;
}

HandJoints ClosedPosture(const HandModel& hand, const HandJoints& open, Rng& rng) {
  HandJoints q = open;
  for (int f = 0; f < hand.num_fingers; ++f) {
    const auto [first, count] = hand.fingers[f];
    for (int j = first + std::max(0, count - 3); j < first + count; ++j) {
      q[j] = open[j] + rng.Uniform(0.5, 1.0) * (hand.q_upper[j] - open[j]);
    }
  }
  const int opposition = hand.fingers[0].first + 1;
  q[opposition] =
      open[opposition] + rng.Uniform(0.3, 1.0) * (hand.q_upper[opposition] - open[opposition]);
  return q;
}

class Closer {
 public:
  Closer(const HandModel& hand, const ShapeWorld& world)
      : hand_(hand),
        obstacles_(Pointers(world)),
        placed_(obstacles_.Place(world.X_WB)),
        object_(world.shapes[0]),
        X_WO_(world.X_WB[0]) {}

  bool IsFree(const HandConfiguration& configuration, const TouchRule& touch) const {
    HandPose pose;
    CalcHandPose(hand_, configuration.X_WH, configuration.q, &pose);
    CapsuleEnds ends;
    CalcCapsuleEnds(hand_, pose, &ends);
    std::vector<HandDistance> near;
    obstacles_.FindNear(hand_, ends, placed_, touch, 0.001, &near);
    FindNearSelf(hand_, ends, 0.001, &near);
    return std::all_of(near.begin(), near.end(), [&](const HandDistance& d) {
      return d.distance >= (d.touch ? -0.9 * touch.depth : 1e-5);
    });
  }

  // A point of the object's surface, or near it, seen from `away`.
  Vector3 SampleSurface(const Vector3& away, Rng& rng) const {
    const AlignedBox& box = object_.bounds();
    const Vector3 share(rng.Uniform(-0.5, 0.5), rng.Uniform(-0.5, 0.5), rng.Uniform(-0.5, 0.5));
    const Vector3 aim =
        X_WO_ * Vector3(box.center() + rng.Uniform() * share.cwiseProduct(box.sizes()));
    double reach = 0.4;
    for (int i = 0; i < 60 && reach > 0.0; ++i) {
      reach -= object_.Calc(X_WO_.inverse() * (aim + reach * away));
    }
    return aim + std::max(0.0, reach) * away;
  }

  DistanceSample TipDistance(const HandConfiguration& configuration, Finger finger,
                             Vector3* p_WT) const {
    HandPose pose;
    CalcHandPose(hand_, configuration.X_WH, configuration.q, &pose);
    const Fingertip& tip = hand_.tip(finger);
    *p_WT = pose.CalcPoint(tip.link, tip.p_LT);
    DistanceSample sample = object_.CalcWithGradient(X_WO_.inverse() * *p_WT);
    sample.phi -= tip.radius;
    sample.nhat = X_WO_.linear() * sample.nhat;
    return sample;
  }

  // Closes one finger from `configuration` towards `closed` until its tip touches.
  std::optional<IkContact> Close(Finger finger, const HandJoints& closed,
                                 HandConfiguration* configuration) const {
    constexpr int kSteps = 40;
    const auto& joints = hand_.fingers[static_cast<int>(finger)];
    const int first = joints.first, count = joints.count;
    const HandJoints open = configuration->q;
    const auto at = [&](double s) {
      HandConfiguration moved = *configuration;
      moved.q.segment(first, count) =
          open.segment(first, count) + s * (closed - open).segment(first, count);
      return moved;
    };
    Vector3 p_WT;
    double low = 0.0;
    double high = -1.0;
    if (TipDistance(at(0.0), finger, &p_WT).phi <= 0.0) return std::nullopt;
    for (int i = 1; i <= kSteps; ++i) {
      const double s = static_cast<double>(i) / kSteps;
      if (TipDistance(at(s), finger, &p_WT).phi <= 0.0) {
        high = s;
        break;
      }
      low = s;
    }
    if (high < 0.0) return std::nullopt;
    for (int i = 0; i < 40; ++i) {
      const double s = 0.5 * (low + high);
      (TipDistance(at(s), finger, &p_WT).phi > 0.0 ? low : high) = s;
    }
    *configuration = at(low);
    const DistanceSample touch = TipDistance(*configuration, finger, &p_WT);
    HandPose pose;
    CalcHandPose(hand_, configuration->X_WH, configuration->q, &pose);
    if (-touch.nhat.dot(pose.R_WL[hand_.tip(finger).link].col(2)) < kTruthCone) return std::nullopt;
    return IkContact{finger, p_WT - (touch.phi + hand_.tip(finger).radius) * touch.nhat,
                     touch.nhat};
  }

 private:
  static std::vector<const Shape*> Pointers(const ShapeWorld& world) {
    std::vector<const Shape*> out;
    for (const Shape& shape : world.shapes) out.push_back(&shape);
    return out;
  }

  const HandModel& hand_;
  HandObstacles obstacles_;
  HandObstacles::Placed placed_;
  SignedDistance object_;
  RigidTransform X_WO_;
};

// The palm a few centimetres over a point of the object, its palmar side (-y) towards it.
RigidTransform SamplePalm(const Closer& closer, Rng& rng) {
  Vector3 away = rng.Direction();
  away.z() = std::abs(away.z());
  const Vector3 p_WP = closer.SampleSurface(away, rng) + rng.Uniform(0.012, 0.06) * away;
  const Vector3 z = away.cross(rng.Direction()).normalized();  // fingers run across
  Matrix3 R_WH;
  R_WH.col(1) = away;
  R_WH.col(2) = z;
  R_WH.col(0) = away.cross(z);
  // The middle of the grasp is in front of the palm, near the fingers' roots.
  const Vector3 p_HP(rng.Uniform(-0.02, 0.04), 0.0, rng.Uniform(0.07, 0.15));
  return MakeTransform(R_WH, p_WP - R_WH * p_HP);
}

std::optional<SolvableProblem> TryHand(const ShapeWorld& world, const Closer& closer, int fingers,
                                       Rng& rng) {
  const HandModel& hand = ShadowHand();
  HandConfiguration configuration;
  configuration.X_WH = SamplePalm(closer, rng);
  configuration.q = OpenPosture(hand, rng);
  const HandJoints closed = ClosedPosture(hand, configuration.q, rng);
  TouchRule touch;
  if (!closer.IsFree(configuration, touch)) return std::nullopt;
  std::array<int, 4> others{1, 2, 3, 4};
  for (std::uint32_t i = 3; i > 0; --i) std::swap(others[i], others[rng.UniformInt(i + 1)]);
  std::vector<IkContact> contacts;
  for (int i = -1; i < 4 && static_cast<int>(contacts.size()) < fingers; ++i) {
    const auto finger = static_cast<Finger>(i < 0 ? 0 : others[i]);
    const HandConfiguration before = configuration;
    auto contact = closer.Close(finger, closed, &configuration);
    TouchRule with = touch;
    with.touching[static_cast<int>(finger)] = true;
    if (contact && closer.IsFree(configuration, with)) {
      contacts.push_back(*contact);
      touch = with;
    } else if (i < 0) {
      return std::nullopt;
    } else {
      configuration = before;
    }
  }
  if (static_cast<int>(contacts.size()) < fingers) return std::nullopt;
  SolvableProblem solvable{world.shapes, {}, configuration};
  solvable.problem.contacts = std::move(contacts);
  solvable.problem.X_WB = world.X_WB;
  return solvable;
}

}  // namespace

TriangleMesh MakeBumpyMesh(double size, Rng& rng) {
  constexpr int kRings = 24;
  constexpr int kSegments = 36;
  const Vector3 half =
      0.5 * size * Vector3(rng.Uniform(0.6, 1.0), rng.Uniform(0.6, 1.0), rng.Uniform(0.4, 1.0));
  const double bumps = rng.Uniform(0.05, 0.2);
  const double phase = rng.Uniform(0.0, 2.0 * kPi);
  const auto vertex = [&](double polar, double azimuth) {
    const double wave =
        1.0 + bumps * std::sin(3.0 * azimuth + phase) * std::sin(polar) * std::sin(polar) +
        bumps * std::cos(4.0 * polar + phase);
    return Vector3(
        wave * half.cwiseProduct(Vector3(std::sin(polar) * std::cos(azimuth),
                                         std::sin(polar) * std::sin(azimuth), std::cos(polar))));
  };
  TriangleMesh mesh;
  mesh.V.resize(2 + (kRings - 1) * kSegments, 3);
  mesh.V.row(0) = vertex(0.0, 0.0);
  mesh.V.row(1) = vertex(kPi, 0.0);
  const auto index = [&](int ring, int segment) {
    return 2 + (ring - 1) * kSegments + segment % kSegments;
  };
  for (int r = 1; r < kRings; ++r) {
    for (int s = 0; s < kSegments; ++s) {
      mesh.V.row(index(r, s)) = vertex(kPi * r / kRings, 2.0 * kPi * s / kSegments);
    }
  }
  std::vector<Eigen::Vector3i> faces;
  for (int s = 0; s < kSegments; ++s) {
    faces.emplace_back(0, index(1, s), index(1, s + 1));
    faces.emplace_back(1, index(kRings - 1, s + 1), index(kRings - 1, s));
    for (int r = 1; r + 1 < kRings; ++r) {
      faces.emplace_back(index(r, s), index(r + 1, s), index(r + 1, s + 1));
      faces.emplace_back(index(r, s), index(r + 1, s + 1), index(r, s + 1));
    }
  }
  mesh.F.resize(static_cast<Eigen::Index>(faces.size()), 3);
  for (std::size_t i = 0; i < faces.size(); ++i)
    mesh.F.row(static_cast<Eigen::Index>(i)) = faces[i];
  return mesh;
}

SolvableProblem MakeSolvableProblem(IkObject object, int fingers, bool clutter, Rng& rng) {
  constexpr int kHandsPerWorld = 2000;
  while (true) {
    const ShapeWorld world = MakeShapeWorld(object, clutter, rng);
    const Closer closer(ShadowHand(), world);
    for (int i = 0; i < kHandsPerWorld; ++i) {
      if (auto solvable = TryHand(world, closer, fingers, rng)) return std::move(*solvable);
    }
  }
}

}  // namespace pregrasp
