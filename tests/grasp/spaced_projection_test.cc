#include "app/grasp/spaced_projection.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/grasp/grasp_scenes.h"

namespace pregrasp {
namespace {

// Five different fingers where their tips can be, with room for all.
void ExpectPlaces(const ContactPlaces& places, const std::vector<GraspContact>& contacts) {
  ASSERT_EQ(contacts.size(), 5U);
  for (int f = 0; f < kNumFingers; ++f) {
    const GraspContact& contact = contacts[f];
    EXPECT_EQ(contact.finger, static_cast<Finger>(f));
    EXPECT_NEAR(places.world().object().Calc(contact.p_OC), 0.0, 1e-6);
    EXPECT_TRUE(places.Allows(contact)) << FingerName(contact.finger);
    for (int g = 0; g < f; ++g) {
      const double apart =
          (TipCentre(TipSpheres{}, contact) - TipCentre(TipSpheres{}, contacts[g])).norm();
      EXPECT_GE(apart,
                TipSpheres{}.radius(contact.finger) + TipSpheres{}.radius(contacts[g].finger))
          << FingerName(contact.finger) << " and " << FingerName(contacts[g].finger);
    }
  }
}

GraspPoints AllAt(const Vector3& p_O) {
  GraspPoints points;
  points.fill(p_O);
  return points;
}

TEST(SpacedProjectionTest, WhateverThePointsTheFingersGetFiveDifferentPlaces) {
  std::vector<Scene> scenes = {RulerScene(0.06), FlatScene({0.2, 0.25, 0.003}, 0.03, 0.04),
                               MarkerScene(), CartonScene(), BookScene()};
  for (const Scene& scene : scenes) {
    const GraspWorld world(scene, ShadowHand());
    const ContactPlaces places(world, world.StartPoses());
    const Vector3 size = world.object().bounds().sizes();
    for (int i = 0; i < 40; ++i) {
      Rng rng(i);
      // From five times one point to points all around.
      const double spread = 0.0005 * i * i / 10.0;
      const Vector3 centre(size.x() * rng.Uniform(-0.6, 0.6), size.y() * rng.Uniform(-0.6, 0.6),
                           size.z() * rng.Uniform(-0.6, 0.6));
      GraspPoints points;
      for (Vector3& p : points) p = centre + spread * rng.Direction();
      SCOPED_TRACE(scene.name + " " + std::to_string(i));
      ExpectPlaces(places, ProjectSpaced(places, points, {}, true));
    }
  }
}

TEST(SpacedProjectionTest, PointsWithRoomGoToTheNearestSurface) {
  const GraspWorld world(FreeCartonScene(), ShadowHand());
  const ContactPlaces places(world, world.StartPoses());
  const GraspPoints points = {Vector3(0.0, 0.040, 0.03), Vector3(0.01, -0.030, 0.06),
                              Vector3(0.0, -0.037, 0.03), Vector3(0.0, -0.035, 0.0),
                              Vector3(-0.01, -0.036, -0.03)};
  const auto contacts = ProjectSpaced(places, points, {}, true);
  ExpectPlaces(places, contacts);
  for (int f = 0; f < kNumFingers; ++f) {
    const Vector3 expected(points[f].x(), f == 0 ? 0.035 : -0.035, points[f].z());
    EXPECT_LT((contacts[f].p_OC - expected).norm(), 1e-9) << f;
  }
}

TEST(SpacedProjectionTest, TwoTipsThatOverlapPartByHalfEach) {
  const GraspWorld world(FreeCartonScene(), ShadowHand());
  const ContactPlaces places(world, world.StartPoses());
  GraspPoints points = {Vector3(0.0, 0.035, 0.0), Vector3(0.0, -0.035, 0.05),
                        Vector3(0.0, -0.035, 0.04), Vector3(0.0, -0.035, 0.0),
                        Vector3(0.0, -0.035, -0.04)};
  const auto contacts = ProjectSpaced(places, points, {}, true);
  const double half = 0.5 * (0.018 + kTipRoom);
  EXPECT_LT((contacts[1].p_OC - Vector3(0.0, -0.035, 0.045 + half)).norm(), 1e-4);
  EXPECT_LT((contacts[2].p_OC - Vector3(0.0, -0.035, 0.045 - half)).norm(), 1e-4);
  EXPECT_EQ(contacts[3].p_OC, points[3]);
}

TEST(SpacedProjectionTest, FiveTipsOnOneSpotStayNearIt) {
  // Around a spot of a wide face: discs of the tips' radii, close together, are within four radii.
  const GraspWorld world(FlatScene({0.2, 0.25, 0.003}, 0.03, 0.04), ShadowHand());
  const ContactPlaces places(world, world.StartPoses());
  const Vector3 spot(0.01, -0.03, 0.0015);
  const auto contacts = ProjectSpaced(places, AllAt(spot), {}, true);
  ExpectPlaces(places, contacts);
  for (const GraspContact& contact : contacts) EXPECT_LT((contact.p_OC - spot).norm(), 0.036);
}

TEST(SpacedProjectionTest, WhatPressesStaysAndTheOthersGiveWay) {
  const GraspWorld world(FreeCartonScene(), ShadowHand());
  const ContactPlaces places(world, world.StartPoses());
  const GraspContact pressing{Finger::kIndex, {0.0, 0.0, 0.1}, Vector3::UnitZ()};
  const auto contacts = ProjectSpaced(places, AllAt({0.0, 0.0, 0.1}), {pressing}, true);
  ExpectPlaces(places, contacts);
  EXPECT_EQ(contacts[1].p_OC, pressing.p_OC);
  EXPECT_EQ(contacts[1].nhat_O, pressing.nhat_O);
}

TEST(SpacedProjectionTest, PointsThatAreNotFiniteGetPlacesToo) {
  const GraspWorld world(FreeCartonScene(), ShadowHand());
  const ContactPlaces places(world, world.StartPoses());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  GraspPoints points = AllAt({0.0, 0.05, 0.0});
  points[0] = Vector3(nan, nan, nan);
  points[3] = Vector3(0.0, std::numeric_limits<double>::infinity(), 0.0);
  ExpectPlaces(places, ProjectSpaced(places, points, {}, false));
  const auto without_ring = ProjectSpaced(places, points, {}, true);
  EXPECT_EQ(without_ring.size(), 4U);
  EXPECT_EQ(FindContact(without_ring, Finger::kRing), nullptr);
}

TEST(ContactPlacesTest, AreWhereAFingertipTouchesNothingElse) {
  const GraspWorld world(CartonScene(), ShadowHand());
  const ContactPlaces places(world, world.StartPoses());
  ASSERT_GT(places.count(Finger::kThumb), 100);
  EXPECT_LT(places.count(Finger::kThumb), places.count(Finger::kIndex));
  for (int i = 0; i < places.count(Finger::kThumb); ++i) {
    const GraspContact contact = places.At(Finger::kThumb, i);
    EXPECT_TRUE(places.Allows(contact));
    // Beside the other cartons and the wall, there is only top and front.
    EXPECT_TRUE(contact.nhat_O.z() > 0.9 || contact.nhat_O.x() > 0.9);
  }
  for (const double distance : {0.003, 0.015, 0.05}) {
    const Vector3 p_O(0.03, 0.01, 0.09);
    int within = 0;
    for (int i = 0; i < places.count(Finger::kRing); ++i) {
      within += (places.At(Finger::kRing, i).p_OC - p_O).norm() <= distance;
    }
    EXPECT_EQ(within, static_cast<int>(places.FindWithin(Finger::kRing, p_O, distance).size()));
  }
}

}  // namespace
}  // namespace pregrasp
