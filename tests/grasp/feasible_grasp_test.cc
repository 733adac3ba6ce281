#include "app/grasp/feasible_grasp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "app/core/error.h"
#include "app/grasp/grasp_search.h"
#include "app/hand/certificate.h"
#include "tests/grasp/grasp_scenes.h"

namespace pregrasp {
namespace {

// One world for all tests of this file: building the hand's reach takes a while.
const GraspWorld& CartonWorld() {
  static const GraspWorld world(FreeCartonScene(), ShadowHand());
  return world;
}

const GraspResult& CartonGrasp() {
  static const GraspResult grasp = [] {
    ThreadPool pool(2);
    GraspSearchConfig config;
    config.max_found = 1;
    const GraspSearchResult result =
        SearchGrasps(CartonWorld(), config, {}, CartonWorld().StartPoses(), 1, pool);
    return result.found.at(0);
  }();
  return grasp;
}

// The free carton is 7 x 7 x 20 cm, standing on the table, its centre at the origin of O.
GraspContact OnSide(Finger finger, double side, double x, double z) {
  return {finger, {x, 0.035 * side, z}, {0, side, 0}};
}

TEST(FeasibleGraspTest, AFoundGraspStandsUpToEveryDemandCheckedByHand) {
  const GraspWorld& world = CartonWorld();
  const GraspResult& grasp = CartonGrasp();
  ASSERT_TRUE(grasp.feasible());
  const RigidTransform X_WO = world.StartPoses()[0];
  const HandModel& hand = ShadowHand();

  // Forces: admissible, and together with the weight zero net wrench about the centre of mass.
  Vector3 force = world.scene().object().mass_properties->mass * world.scene().gravity;
  Vector3 torque = Vector3::Zero();
  for (std::size_t i = 0; i < grasp.contacts.size(); ++i) {
    const GraspContact& contact = grasp.contacts[i];
    const Vector3 f_O = grasp.wrench->forces.row(static_cast<int>(i));
    const double normal = -f_O.dot(contact.nhat_O);
    EXPECT_GE(normal, 0.5 - 1e-9);
    EXPECT_LE(normal, 12.0 + 1e-9);
    EXPECT_LE((f_O + normal * contact.nhat_O).norm(), 0.8 * normal + 1e-9);
    force += X_WO.linear() * f_O;
    torque += (X_WO.linear() * contact.p_OC).cross(X_WO.linear() * f_O);
    EXPECT_NEAR(world.object().Calc(contact.p_OC), 0.0, 1e-6);
  }
  EXPECT_LT(force.norm(), 1e-7);
  EXPECT_LT(torque.norm(), 1e-7);

  // Kinematics, from the configuration alone.
  const IkResult& ik = grasp.kinematics->ik;
  HandPose pose;
  CalcHandPose(hand, ik.X_WH, ik.q, &pose);
  TouchRule touch;
  for (const GraspContact& contact : grasp.contacts) {
    const Fingertip& tip = hand.tip(contact.finger);
    touch.touching[static_cast<int>(contact.finger)] = true;
    EXPECT_LE((pose.CalcPoint(tip.link, tip.p_LT) - X_WO * TipCentre(TipSpheres{}, contact)).norm(),
              2e-3);
    const double cosine = -pose.R_WL[tip.link].col(2).dot(X_WO.linear() * contact.nhat_O);
    EXPECT_GE(cosine, std::cos(DegToRad(60.0)) - 1e-9);
    for (const GraspContact& other : grasp.contacts) {
      if (other.finger == contact.finger) continue;
      EXPECT_GE((TipCentre(TipSpheres{}, contact) - TipCentre(TipSpheres{}, other)).norm(),
                TipSpheres{}.radius(contact.finger) + TipSpheres{}.radius(other.finger));
    }
  }
  EXPECT_TRUE(((ik.q - hand.q_lower).array() >= 0.0).all());
  EXPECT_TRUE(((hand.q_upper - ik.q).array() >= 0.0).all());
  std::vector<const Shape*> shapes;
  for (const Body& body : world.scene().bodies) shapes.push_back(&body.shape);
  const HandCertificate fcl(hand, shapes);
  EXPECT_TRUE(fcl.FindCollisions(ik.configuration(), world.StartPoses(), touch).empty());
  for (const Finger finger : {Finger::kThumb, Finger::kIndex, Finger::kMiddle}) {
    EXPECT_TRUE(grasp.uses(finger));
  }
}

TEST(FeasibleGraspTest, EachFailureNamesTheFirstDemandThatIsNotMet) {
  const GraspWorld& world = CartonWorld();
  const std::vector<RigidTransform> start = world.StartPoses();
  GraspConfig config;
  config.kinematics.ik.max_starts = 5;
  std::string sentence;
  const auto status = [&](const std::vector<GraspContact>& contacts) {
    const GraspResult result =
        TestContacts(world, config, contacts, start, Rng(1, RngStream::kTest));
    EXPECT_EQ(result.feasible(), result.status == GraspStatus::kFeasible);
    sentence = Explain(result);
    return result.status;
  };
  EXPECT_EQ(status({OnSide(Finger::kThumb, 1, 0, 0), OnSide(Finger::kIndex, -1, 0, 0),
                    OnSide(Finger::kMiddle, -1, 0.01, 0)}),
            GraspStatus::kTipsTooClose);
  EXPECT_EQ(sentence,
            "thumb, index, middle: the fingertips of index and middle would overlap by 8.0 mm");
  EXPECT_EQ(status({OnSide(Finger::kThumb, 1, 0, 0), OnSide(Finger::kIndex, 1, 0.02, 0),
                    OnSide(Finger::kMiddle, 1, -0.02, 0)}),
            GraspStatus::kNoInternalForces);
  // Three fingers push the same way with 0.5 N at least.
  EXPECT_EQ(sentence,
            "thumb, index, middle: no forces within cones and limits cancel out; those tried miss "
            "by 1.50 N");
  // The centre of mass lies far below the line on which they press.
  Scene heavy = FreeCartonScene();
  heavy.object().mass_properties->mass = 5.0;
  const GraspWorld heavy_world(heavy, ShadowHand());
  EXPECT_EQ(TestContacts(heavy_world, config,
                         {OnSide(Finger::kThumb, 1, 0, 0), OnSide(Finger::kIndex, -1, 0.01, 0),
                          OnSide(Finger::kMiddle, -1, -0.01, 0)},
                         start, Rng(1, RngStream::kTest))
                .status,
            GraspStatus::kWeightNotBalanced);
  // Index and middle finger 17 cm apart.
  EXPECT_EQ(status({OnSide(Finger::kThumb, 1, 0, 0), OnSide(Finger::kIndex, -1, 0, 0.085),
                    OnSide(Finger::kMiddle, -1, 0, -0.085)}),
            GraspStatus::kTipError);
  // Within reach as such, but below the table's top.
  EXPECT_EQ(status({OnSide(Finger::kThumb, 1, 0, -0.099), OnSide(Finger::kIndex, -1, 0.02, -0.099),
                    OnSide(Finger::kMiddle, -1, -0.02, -0.099)}),
            GraspStatus::kCollision);
  EXPECT_NE(sentence.find("would overlap table by"), std::string::npos) << sentence;
}

TEST(FeasibleGraspTest, AFailureSaysAsDataWhatStandsInTheWay) {
  const GraspWorld& world = CartonWorld();
  GraspConfig config;
  config.kinematics.ik.max_starts = 5;
  const auto test = [&](const std::vector<GraspContact>& contacts) {
    return TestContacts(world, config, contacts, world.StartPoses(), Rng(1, RngStream::kTest));
  };
  const GraspResult close = test({OnSide(Finger::kThumb, 1, 0, 0), OnSide(Finger::kIndex, -1, 0, 0),
                                  OnSide(Finger::kMiddle, -1, 0.01, 0)});
  ASSERT_TRUE(close.fault.tips.has_value());
  EXPECT_EQ(close.fault.tips->fingers, (std::array<Finger, 2>{Finger::kIndex, Finger::kMiddle}));
  EXPECT_NEAR(close.fault.tips->gap, -0.008, 1e-12);
  EXPECT_FALSE(close.fault.missing_wrench || close.fault.overlap || close.fault.finger);

  // All three push along -y: what is missing is along +y, and no admissible force has any of it.
  const GraspResult loose =
      test({OnSide(Finger::kThumb, 1, 0, 0), OnSide(Finger::kIndex, 1, 0.02, 0),
            OnSide(Finger::kMiddle, 1, -0.02, 0)});
  ASSERT_EQ(loose.status, GraspStatus::kNoInternalForces);
  ASSERT_TRUE(loose.fault.missing_wrench.has_value());
  const Vector6& missing = *loose.fault.missing_wrench;
  EXPECT_NEAR(missing.norm(), 1.0, 1e-12);
  EXPECT_GT(missing[1], 0.5);
  Rng rng(4);
  for (int i = 0; i < 2000; ++i) {
    Vector6 wrench = Vector6::Zero();
    for (const GraspContact& contact : loose.contacts) {
      const double normal = rng.Uniform(0.5, 12.0), across = 0.8 * normal * rng.Uniform();
      const double angle = rng.Uniform(0.0, 2.0 * kPi);
      const Vector3 f(across * std::cos(angle), -normal, across * std::sin(angle));
      wrench.head<3>() += f;
      wrench.tail<3>() += contact.p_OC.cross(f) / world.object_radius();
    }
    EXPECT_LT(missing.dot(wrench), 0.0);
  }

  const GraspResult low =
      test({OnSide(Finger::kThumb, 1, 0, -0.099), OnSide(Finger::kIndex, -1, 0.02, -0.099),
            OnSide(Finger::kMiddle, -1, -0.02, -0.099)});
  ASSERT_EQ(low.status, GraspStatus::kCollision);
  ASSERT_TRUE(low.fault.overlap.has_value());
  EXPECT_EQ(low.fault.overlap->other, "table");
  EXPECT_FALSE(low.fault.overlap->link.empty());
  EXPECT_GT(low.fault.overlap->depth, 0.0);

  const GraspResult far =
      test({OnSide(Finger::kThumb, 1, 0, 0), OnSide(Finger::kIndex, -1, 0, 0.085),
            OnSide(Finger::kMiddle, -1, 0, -0.085)});
  ASSERT_EQ(far.status, GraspStatus::kTipError);
  EXPECT_TRUE(far.fault.finger.has_value());
}

TEST(FeasibleGraspTest, ContactsThatAreNotNumbersNeverPass) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<GraspContact> contacts = CartonGrasp().contacts;
  contacts.back().p_OC.x() = nan;
  const GraspWorld& world = CartonWorld();
  EXPECT_TRUE(std::isnan(FindNearestTips(TipSpheres{}, contacts).gap));
  EXPECT_EQ(TestContacts(world, {}, contacts, world.StartPoses(), Rng(1, RngStream::kTest)).status,
            GraspStatus::kTipsTooClose);
}

TEST(FeasibleGraspTest, RingAndLittleMayBeDroppedButNoOther) {
  const GraspWorld& world = CartonWorld();
  std::vector<GraspContact> contacts;
  for (const GraspContact& contact : CartonGrasp().contacts) {
    if (contact.finger <= Finger::kMiddle) contacts.push_back(contact);
  }
  ThreadPool pool(2);
  GraspSearchConfig search;
  search.max_found = 4;
  GraspResult three;
  for (const GraspResult& found :
       SearchGrasps(world, search, {}, world.StartPoses(), 5, pool).found) {
    if (found.contacts.size() == 3) three = found;
  }
  ASSERT_TRUE(three.feasible());
  // A little finger's contact on the thumb's spoils the set, not the grasp.
  std::vector<GraspContact> five = three.contacts;
  five.push_back(five.front());
  five.back().finger = Finger::kLittle;
  const HandConfiguration warm_start = three.kinematics->ik.configuration();
  const Rng rng(1, RngStream::kTest);
  GraspConfig config;
  const GraspResult dropped = TestGrasp(world, config, five, world.StartPoses(), rng, &warm_start);
  EXPECT_TRUE(dropped.feasible());
  EXPECT_FALSE(dropped.uses(Finger::kLittle));
  EXPECT_EQ(dropped.contacts.size(), 3U);
  config.may_drop = false;
  EXPECT_EQ(TestGrasp(world, config, five, world.StartPoses(), rng, &warm_start).status,
            GraspStatus::kTipsTooClose);
  config.may_drop = true;
  five.back().finger = Finger::kMiddle;
  five[2].finger = Finger::kLittle;
  EXPECT_FALSE(TestGrasp(world, config, five, world.StartPoses(), rng, &warm_start).feasible());
}

TEST(FeasibleGraspTest, TheSearchFindsTheSameForAnyNumberOfThreads) {
  const GraspWorld& world = CartonWorld();
  GraspSearchConfig config;
  config.max_found = 3;
  std::optional<GraspSearchResult> first;
  for (const int threads : {1, 2, 3}) {
    ThreadPool pool(threads);
    const GraspSearchResult result = SearchGrasps(world, config, {}, world.StartPoses(), 7, pool);
    ASSERT_GE(result.found.size(), 1U);
    if (!first) {
      first = result;
      continue;
    }
    EXPECT_EQ(result.stats.drawn, first->stats.drawn);
    EXPECT_EQ(result.stats.held, first->stats.held);
    EXPECT_EQ(result.stats.tried, first->stats.tried);
    ASSERT_EQ(result.found.size(), first->found.size());
    for (std::size_t i = 0; i < result.found.size(); ++i) {
      EXPECT_EQ(result.found[i].kinematics->ik.q, first->found[i].kinematics->ik.q);
      EXPECT_EQ(result.found[i].wrench->forces, first->found[i].wrench->forces);
    }
  }
}

TEST(FeasibleGraspTest, ASearchWithFixedContactsKeepsThem) {
  const GraspWorld& world = CartonWorld();
  ThreadPool pool(2);
  GraspSearchConfig config;
  config.max_found = 2;
  const std::vector<GraspContact> fixed{CartonGrasp().contacts[0], CartonGrasp().contacts[1]};
  const GraspSearchResult result = SearchGrasps(world, config, fixed, world.StartPoses(), 3, pool);
  ASSERT_FALSE(result.found.empty());
  for (const GraspResult& grasp : result.found) {
    for (int i = 0; i < 2; ++i) {
      EXPECT_EQ(grasp.contacts[i].finger, fixed[i].finger);
      EXPECT_EQ(grasp.contacts[i].p_OC, fixed[i].p_OC);
    }
  }
}

TEST(ContactSamplerTest, SetsArePlausible) {
  const GraspWorld& world = CartonWorld();
  for (const double near_share : {0.0, 1.0}) {
    SamplerConfig config;
    config.near_share = near_share;
    const ContactSampler sampler(world, world.StartPoses(), config);
    EXPECT_LT(sampler.num_points(Finger::kThumb), sampler.num_points(Finger::kIndex));
    int drawn = 0, opposed = 0, fingers[6] = {};
    for (int i = 0; i < 500; ++i) {
      Rng rng(1, RngStream::kTest, 1, i);
      const auto contacts = sampler.Sample({}, rng);
      if (!contacts) continue;
      ++drawn;
      ++fingers[contacts->size()];
      bool any_opposed = false;
      for (const GraspContact& a : *contacts) {
        EXPECT_NEAR(world.object().Calc(a.p_OC), 0.0, 1e-5);
        EXPECT_TRUE(CanTouch(a.p_OC, a.nhat_O, TipSpheres{}.radius(a.finger), {}, world.object(),
                             world.environment(), world.StartPoses()));
        const int f = static_cast<int>(a.finger);
        any_opposed |= contacts->front().nhat_O.dot(a.nhat_O) < -0.9;
        for (const GraspContact& b : *contacts) {
          const int g = static_cast<int>(b.finger);
          if (f >= g) continue;
          const double distance = (TipCentre(TipSpheres{}, a) - TipCentre(TipSpheres{}, b)).norm();
          EXPECT_GE(distance, TipSpheres{}.radius(a.finger) + TipSpheres{}.radius(b.finger));
          EXPECT_LE(distance, world.reach().farthest[f][g]);
          if (near_share == 1.0 && f > 0) {
            EXPECT_LE(distance, 0.03 * (g - f) + 0.01 + 1e-12);
          }
        }
      }
      opposed += any_opposed;
    }
    EXPECT_GT(drawn, 300);
    EXPECT_GT(opposed, drawn / 3);
    for (const int size : {3, 4, 5}) EXPECT_GT(fingers[size], drawn / 20);
  }
}

TEST(TipReachTest, NeighbouringFingersReachLessFarThanThumbAndFingerAndTheTableIsSymmetric) {
  const TipReach& reach = CartonWorld().reach();
  for (int a = 0; a < kNumFingers; ++a) {
    for (int b = 0; b < kNumFingers; ++b) {
      EXPECT_EQ(reach.nearest[a][b], reach.nearest[b][a]);
      if (a == b) continue;
      EXPECT_LT(reach.nearest[a][b], 0.04);
      EXPECT_GT(reach.farthest[a][b], 0.06);
      EXPECT_LT(reach.farthest[a][b], 0.30);
    }
  }
}

}  // namespace
}  // namespace pregrasp
