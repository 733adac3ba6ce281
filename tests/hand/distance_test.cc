#include "app/hand/distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/geometry/signed_distance.h"
#include "app/hand/segment_distance.h"
#include "app/hand/solvable_problem.h"
#include "tests/hand/hand_test_data.h"

namespace pregrasp {
namespace {

struct Segment {
  Vector3 a, b;
};

Segment RandomSegment(Rng& rng, double reach) {
  const auto point = [&] {
    return Vector3(rng.Uniform(-reach, reach), rng.Uniform(-reach, reach),
                   rng.Uniform(-reach, reach));
  };
  const Vector3 a = point();
  return {a, a + rng.Uniform(0.0, 0.08) * rng.Direction()};
}

// Least of a function along a segment, by sampling.
template <typename Distance>
double SampleLeast(const Distance& distance, const Segment& segment, int samples) {
  double least = 1e9;
  for (int i = 0; i <= samples; ++i) {
    const double t = static_cast<double>(i) / samples;
    least = std::min(least, distance((1.0 - t) * segment.a + t * segment.b));
  }
  return least;
}

template <typename Primitive>
void ExpectLeastIsExact(const Primitive& primitive) {
  Rng rng(1);
  for (int trial = 0; trial < 300; ++trial) {
    const Segment s = RandomSegment(rng, 0.1);
    const SegmentSample found = FindLeastConvex(
        [&](const Vector3& p) { return CalcDistanceWithGradient(primitive, p); }, s.a, s.b);
    const double sampled =
        SampleLeast([&](const Vector3& p) { return CalcDistance(primitive, p); }, s, 2000);
    // Samples are at most 40 um apart.
    EXPECT_LE(found.sample.phi, sampled + 1e-8);
    EXPECT_GE(found.sample.phi, sampled - 2.1e-5);
    EXPECT_NEAR(CalcDistance(primitive, s.a + found.t * (s.b - s.a)), found.sample.phi, 1e-12);
  }
}

TEST(SegmentDistanceTest, LeastOfABoxCylinderSphereAndCapsuleIsThatOfDenseSamples) {
  ExpectLeastIsExact(Box{{0.08, 0.05, 0.03}});
  ExpectLeastIsExact(Cylinder{0.03, 0.09});
  ExpectLeastIsExact(Sphere{0.04});
  ExpectLeastIsExact(Capsule{0.02, 0.06});
}

TEST(SegmentDistanceTest, LeastOfAMeshIsThatOfDenseSamples) {
  Rng rng(2);
  int outside = 0;
  for (int shape = 0; shape < 5; ++shape) {
    const MeshDistance mesh(MakeBumpyMesh(0.1, rng));
    for (int trial = 0; trial < 60; ++trial) {
      const Segment s = RandomSegment(rng, 0.09);
      const SegmentSample found = FindLeastOnMesh(mesh, s.a, s.b, 0.2);
      const double sampled = SampleLeast([&](const Vector3& p) { return mesh.Calc(p); }, s, 2000);
      EXPECT_NEAR(mesh.Calc(s.a + found.t * (s.b - s.a)), found.sample.phi, 1e-9);
      EXPECT_EQ(found.sample.phi > 0.0, sampled > 0.0);
      if (sampled > 0.0) {
        ++outside;
        EXPECT_LE(found.sample.phi, sampled + 1e-8);
        EXPECT_GE(found.sample.phi, sampled - 2.1e-5);
      } else {
        EXPECT_NEAR(found.sample.phi, sampled, 2e-3);  // steps of 4 mm
      }
      // Beyond a cutoff only that it is beyond is known.
      const double cutoff = 0.5 * found.sample.phi;
      if (cutoff > 0.0) {
        EXPECT_GT(FindLeastOnMesh(mesh, s.a, s.b, cutoff).sample.phi, cutoff);
      }
    }
  }
  EXPECT_GT(outside, 100);
}

TEST(SegmentDistanceTest, NearestPointsOfSegmentsAreThoseOfDenseSamples) {
  Rng rng(3);
  for (int trial = 0; trial < 300; ++trial) {
    const Segment u = RandomSegment(rng, 0.05);
    Segment v = RandomSegment(rng, 0.05);
    if (trial % 4 == 1) v.b = v.a + rng.Uniform(-1.0, 1.0) * (u.b - u.a);  // parallel
    if (trial % 4 == 2) v.b = v.a;                                         // a point
    double s = 0.0;
    double t = 0.0;
    FindNearestOnSegments(u.a, u.b, v.a, v.b, &s, &t);
    ASSERT_TRUE(s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0);
    const double found = (u.a + s * (u.b - u.a) - v.a - t * (v.b - v.a)).norm();
    const double sampled = SampleLeast(
        [&](const Vector3& p) {
          return SampleLeast([&](const Vector3& q) { return (p - q).norm(); }, v, 200);
        },
        u, 200);
    EXPECT_LE(found, sampled + 1e-12);
    EXPECT_GE(found, sampled - 4.1e-4);
  }
}

// What the tests below measure to: one of each kind of shape, around the origin.
struct Bodies {
  std::vector<Shape> shapes;
  std::vector<RigidTransform> X_WB;

  std::vector<const Shape*> pointers() const {
    std::vector<const Shape*> out;
    for (const Shape& shape : shapes) out.push_back(&shape);
    return out;
  }
};

Bodies MakeBodies(Rng& rng) {
  Mesh mesh;
  mesh.mesh = MakeBumpyMesh(0.12, rng);
  const Union whole{{{Box{{0.1, 0.02, 0.02}}, RigidTransform::Identity()},
                     {Cylinder{0.02, 0.1}, MakeTransform(rng.Rotation(), Vector3(0, 0.02, 0))}}};
  Bodies bodies{
      {mesh, Box{{0.1, 0.06, 0.04}}, Cylinder{0.03, 0.1}, Sphere{0.04}, Capsule{0.02, 0.1}, whole},
      {}};
  for (std::size_t i = 0; i < bodies.shapes.size(); ++i) {
    const Quaternion q = rng.Rotation();
    bodies.X_WB.push_back(MakeTransform(q, 0.15 * rng.Direction()));
  }
  return bodies;
}

std::vector<HandDistance> FindAll(const HandObstacles& obstacles, const Bodies& bodies,
                                  const HandConfiguration& configuration, const TouchRule& touch,
                                  double influence) {
  HandPose pose;
  CalcHandPose(ShadowHand(), configuration.X_WH, configuration.q, &pose);
  CapsuleEnds ends;
  CalcCapsuleEnds(ShadowHand(), pose, &ends);
  std::vector<HandDistance> near;
  obstacles.FindNear(ShadowHand(), ends, obstacles.Place(bodies.X_WB), touch, influence, &near);
  FindNearSelf(ShadowHand(), ends, influence, &near);
  return near;
}

HandConfiguration NearOrigin(Rng& rng) {
  HandConfiguration configuration = RandomConfiguration(ShadowHand(), rng);
  configuration.X_WH.translation() *= 0.4;
  return configuration;
}

TEST(HandDistanceTest, EveryPairNearerThanTheInfluenceIsFoundAndNoOther) {
  Rng rng(4);
  const Bodies bodies = MakeBodies(rng);
  const HandObstacles obstacles(bodies.pointers());
  constexpr double kInfluence = 0.01;
  for (int trial = 0; trial < 15; ++trial) {
    const HandConfiguration configuration = NearOrigin(rng);
    HandPose pose;
    CalcHandPose(ShadowHand(), configuration.X_WH, configuration.q, &pose);
    CapsuleEnds ends;
    CalcCapsuleEnds(ShadowHand(), pose, &ends);
    const std::vector<HandDistance> near =
        FindAll(obstacles, bodies, configuration, {}, kInfluence);
    for (std::size_t body = 0; body < bodies.shapes.size(); ++body) {
      const SignedDistance distance(bodies.shapes[body]);
      const RigidTransform X_BW = bodies.X_WB[body].inverse();
      for (std::size_t i = 0; i < ShadowHand().capsules.size(); ++i) {
        const double sampled =
            SampleLeast([&](const Vector3& p) { return distance.Calc(X_BW * p); },
                        {ends.p_WA[i], ends.p_WB[i]}, 200) -
            ShadowHand().capsules[i].radius;
        double found = 1.0;
        for (const HandDistance& d : near) {
          if (d.pair != HandPair::kSelf && d.other == static_cast<int>(body) &&
              d.capsule == static_cast<int>(i)) {
            found = std::min(found, d.distance);
          }
        }
        if (sampled > kInfluence + 4e-4) {
          EXPECT_EQ(found, 1.0);
        } else if (sampled < kInfluence) {
          EXPECT_NEAR(found, sampled, sampled < 0.0 ? 2.2e-3 : 4e-4);
        }
      }
    }
  }
}

TEST(HandDistanceTest, GradientsAreTheDifferenceQuotients) {
  constexpr double kStep = 1e-6;
  Rng rng(5);
  int compared = 0;
  int wrong = 0;
  for (int trial = 0; trial < 12; ++trial) {
    const Bodies bodies = MakeBodies(rng);
    const HandObstacles obstacles(bodies.pointers());
    const HandConfiguration start = NearOrigin(rng);
    HandPose pose;
    CalcHandPose(ShadowHand(), start.X_WH, start.q, &pose);
    const auto near = FindAll(obstacles, bodies, start, {}, 0.02);
    const auto at = [&](const HandVector& step) {
      return FindAll(obstacles, bodies, Advance(start, step), {}, 0.03);
    };
    for (int i = 0; i < kMaxHandDofs; ++i) {
      const auto plus = at(kStep * HandVector::Unit(i));
      const auto minus = at(-kStep * HandVector::Unit(i));
      const auto find = [](const std::vector<HandDistance>& list, const HandDistance& d) {
        return std::count_if(list.begin(), list.end(),
                             [&](const HandDistance& e) {
                               return e.pair == d.pair && e.capsule == d.capsule &&
                                      e.other == d.other;
                             }) == 1
                   ? &*std::find_if(list.begin(), list.end(),
                                    [&](const HandDistance& e) {
                                      return e.pair == d.pair && e.capsule == d.capsule &&
                                             e.other == d.other;
                                    })
                   : nullptr;
      };
      for (const HandDistance& d : near) {
        const HandDistance* up = find(plus, d);
        const HandDistance* down = find(minus, d);
        if (up == nullptr || down == nullptr) continue;  // a union's parts share one name
        HandVector gradient = HandVector::Zero();
        AddDistanceGradient(ShadowHand(), pose, d, 1.0, &gradient);
        const double quotient = (up->distance - down->distance) / (2.0 * kStep);
        ++compared;
        // A witness that jumps between two faces (inside a body, or along a parallel one) has no
        // derivative; such kinks are rare.
        wrong += std::abs(gradient[i] - quotient) > 1e-4;
      }
    }
  }
  EXPECT_GT(compared, 5000);
  EXPECT_LT(wrong, compared / 200);
}

TEST(HandDistanceTest, OnlyTouchingDistalLinksWithTheObjectAreTouches) {
  const Shape box = Box{{0.4, 0.4, 0.4}};
  Bodies bodies{{box, box}, {RigidTransform::Identity(), RigidTransform::Identity()}};
  const HandObstacles obstacles(bodies.pointers());
  TouchRule touch;
  touch.touching[static_cast<int>(Finger::kIndex)] = true;
  int touches = 0;
  for (const HandDistance& d : FindAll(obstacles, bodies, {}, touch, 0.01)) {
    if (!d.touch) continue;
    ++touches;
    EXPECT_EQ(d.pair, HandPair::kObject);
    EXPECT_EQ(ShadowHand().capsules[d.capsule].name, "ffdistal/pad");
  }
  EXPECT_EQ(touches, 1);
}

}  // namespace
}  // namespace pregrasp
