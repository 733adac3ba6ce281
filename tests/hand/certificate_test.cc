#include "app/hand/certificate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "app/hand/solvable_problem.h"
#include "tests/hand/hand_test_data.h"

namespace pregrasp {
namespace {

using Key = std::tuple<HandPair, int, int>;

std::vector<const Shape*> Pointers(const std::vector<Shape>& shapes) {
  std::vector<const Shape*> out;
  for (const Shape& shape : shapes) out.push_back(&shape);
  return out;
}

// FCL and our distances must agree about every pair that is not within `kBand` of touching.
TEST(CertificateTest, FclAgreesWithOurDistancesAboutEveryPair) {
  constexpr double kBand = 1e-5;
  Rng rng(1);
  int collisions = 0;
  int free = 0;
  for (int trial = 0; trial < 60; ++trial) {
    Mesh mesh;
    mesh.mesh = MakeBumpyMesh(0.12, rng);
    const std::vector<Shape> shapes{mesh, Box{{0.1, 0.06, 0.04}}, Cylinder{0.03, 0.1}, Sphere{0.04},
                                    Capsule{0.02, 0.1}};
    std::vector<RigidTransform> X_WB;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      const Quaternion q = rng.Rotation();
      X_WB.push_back(MakeTransform(q, 0.15 * rng.Direction()));
    }
    HandConfiguration configuration = RandomConfiguration(ShadowHand(), rng);
    configuration.X_WH.translation() *= 0.4;
    TouchRule touch;
    touch.touching[0] = touch.touching[1] = true;
    std::set<Key> by_fcl;
    for (const HandCollision& c : HandCertificate(ShadowHand(), Pointers(shapes))
                                      .FindCollisions(configuration, X_WB, touch)) {
      by_fcl.emplace(c.pair, c.capsule, c.other);
    }
    const HandObstacles obstacles(Pointers(shapes));
    HandPose pose;
    CalcHandPose(ShadowHand(), configuration.X_WH, configuration.q, &pose);
    CapsuleEnds ends;
    CalcCapsuleEnds(ShadowHand(), pose, &ends);
    std::vector<HandDistance> near;
    obstacles.FindNear(ShadowHand(), ends, obstacles.Place(X_WB), touch, 1.0, &near);
    FindNearSelf(ShadowHand(), ends, 1.0, &near);
    for (const HandDistance& d : near) {
      const double gap = d.distance + (d.touch ? touch.depth : 0.0);
      if (std::abs(gap) < kBand) continue;
      const bool hit = by_fcl.count({d.pair, d.capsule, d.other}) > 0;
      EXPECT_EQ(hit, gap < 0.0) << "gap " << gap << ", capsule "
                                << ShadowHand().capsules[d.capsule].name << ", other " << d.other;
      (hit ? collisions : free) += 1;
    }
  }
  EXPECT_GT(collisions, 200);
  EXPECT_GT(free, 5000);
}

TEST(CertificateTest, AHandInsideAMeshCollidesAlthoughItTouchesNoTriangle) {
  TriangleMesh cube;
  cube.V.resize(8, 3);
  for (int i = 0; i < 8; ++i)
    cube.V.row(i) << (i & 1) - 0.5, (i >> 1 & 1) - 0.5, (i >> 2 & 1) - 0.5;
  cube.F.resize(12, 3);
  cube.F << 0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4,
      6, 1, 3, 5, 3, 7, 5;
  Mesh mesh;
  mesh.mesh = cube;
  const Shape shape = mesh;
  const HandCertificate certificate(ShadowHand(), {&shape});
  const auto collisions = certificate.FindCollisions({}, {RigidTransform::Identity()}, {});
  EXPECT_EQ(collisions.size(), ShadowHand().capsules.size());
  EXPECT_EQ(certificate.FindCollisions({}, {RigidTransform::Identity()}, {}, true).size(), 1U);
  const RigidTransform far = MakeTransform(Matrix3::Identity(), Vector3(5.0, 0.0, 0.0));
  EXPECT_TRUE(certificate.FindCollisions({}, {far}, {}).empty());
}

TEST(CertificateTest, TheRelaxedAndTheZeroPostureAreFree) {
  const HandCertificate certificate(ShadowHand(), {});
  EXPECT_TRUE(certificate.FindCollisions({}, {}, {}).empty());
  HandConfiguration relaxed;
  relaxed.q = ShadowHand().posture;
  EXPECT_TRUE(certificate.FindCollisions(relaxed, {}, {}).empty());
}

TEST(CertificateTest, AFistThroughItselfIsACollision) {
  HandConfiguration fist;
  for (int j = 0; j < kMaxHandJoints; ++j) fist.q[j] = ShadowHand().q_upper[j];
  EXPECT_FALSE(HandCertificate(ShadowHand(), {}).FindCollisions(fist, {}, {}).empty());
}

}  // namespace
}  // namespace pregrasp
