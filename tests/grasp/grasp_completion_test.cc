#include "app/grasp/grasp_completion.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "app/core/error.h"
#include "app/grasp/grasp_search.h"
#include "tests/grasp/grasp_scenes.h"

namespace pregrasp {
namespace {

// Feasible grasps of a carton on a table, disturbed: what a generator gives.
class GraspCompletionTest : public ::testing::Test {
 protected:
  GraspCompletionTest() : scene_(FreeCartonScene()), world_(scene_, ShadowHand()) {
    ThreadPool pool(1);
    GraspSearchConfig config;
    config.max_found = 40;
    config.max_sets = 400000;
    config.max_solves = 4000;
    for (const GraspResult& grasp :
         SearchGrasps(world_, config, {}, world_.StartPoses(), 1, pool).found) {
      if (grasp.contacts.size() == 5) found_.push_back(grasp);
    }
  }

  GraspPoints Disturb(const GraspResult& grasp, double distance, Rng rng) const {
    GraspPoints points;
    for (const GraspContact& contact : grasp.contacts) {
      points[static_cast<int>(contact.finger)] = contact.p_OC + distance * rng.Direction();
    }
    return points;
  }

  std::vector<GeneratedGrasp> DisturbAll(double distance) const {
    std::vector<GeneratedGrasp> generated;
    for (std::size_t i = 0; i < 10 * found_.size(); ++i) {
      generated.push_back({Disturb(found_[i / 10], distance, Rng(i)), Rng(i, RngStream::kTest)});
    }
    return generated;
  }

  CompletionResult Complete(const std::vector<GeneratedGrasp>& generated, int threads,
                            const CompletionConfig& config = {}) const {
    ThreadPool pool(threads);
    const ContactPlaces places(world_, world_.StartPoses());
    return CompleteGrasps(places, config, generated, {}, pool);
  }

  Scene scene_;
  GraspWorld world_;
  std::vector<GraspResult> found_;
};

int CountFeasible(const std::vector<CompletedGrasp>& grasps, GraspResult CompletedGrasp::*which) {
  return static_cast<int>(
      std::count_if(grasps.begin(), grasps.end(),
                    [&](const CompletedGrasp& grasp) { return (grasp.*which).feasible(); }));
}

TEST_F(GraspCompletionTest, WhatItCallsFeasibleIsSoAndWithinTheMovesAllowed) {
  ASSERT_FALSE(found_.empty());
  const CompletionResult result = Complete(DisturbAll(0.015), 2);
  ASSERT_EQ(result.grasps.size(), 10 * found_.size());
  const ContactPlaces places(world_, world_.StartPoses());
  for (const CompletedGrasp& grasp : result.grasps) {
    EXPECT_EQ(grasp.source, GraspSource::kGenerator);
    ASSERT_EQ(grasp.projected.size(), 5U);
    EXPECT_GE(FindNearestTips(TipSpheres{}, grasp.projected).gap, 0.0);
    EXPECT_LE(grasp.moved, 0.010 + 1e-12);
    if (grasp.raw.feasible()) {
      EXPECT_TRUE(grasp.feasible());
    }
    if (!grasp.feasible()) continue;
    double moved = 0.0;
    for (const GraspContact& contact : grasp.result.contacts) {
      EXPECT_TRUE(places.Allows(contact));
      moved = std::max(
          moved, (contact.p_OC - grasp.projected[static_cast<int>(contact.finger)].p_OC).norm());
    }
    EXPECT_NEAR(moved, grasp.moved, 1e-12);
    for (const Finger finger : {Finger::kThumb, Finger::kIndex, Finger::kMiddle}) {
      EXPECT_TRUE(grasp.result.uses(finger));
    }
    // Tested anew, from the hand pose that it gives.
    const HandConfiguration hand = grasp.result.kinematics->ik.configuration();
    EXPECT_TRUE(TestContacts(world_, GraspConfig(), grasp.result.contacts, world_.StartPoses(),
                             Rng(99, RngStream::kTest), &hand)
                    .feasible());
  }
}

TEST_F(GraspCompletionTest, RefinementRepairsMostGraspsThatAreMillimetresOff) {
  const CompletionResult result = Complete(DisturbAll(0.015), 2);
  const int raw = CountFeasible(result.grasps, &CompletedGrasp::raw);
  const int refined = CountFeasible(result.grasps, &CompletedGrasp::result);
  const int all = static_cast<int>(result.grasps.size());
  EXPECT_LT(raw, all);
  EXPECT_GE(refined - raw, (all - raw) / 2);
}

TEST_F(GraspCompletionTest, IsTheSameForAnyNumberOfThreads) {
  const std::vector<GeneratedGrasp> generated = DisturbAll(0.015);
  const CompletionResult one = Complete(generated, 1);
  for (const int threads : {2, 3}) {
    const CompletionResult other = Complete(generated, threads);
    ASSERT_EQ(one.grasps.size(), other.grasps.size());
    for (std::size_t i = 0; i < one.grasps.size(); ++i) {
      const GraspResult& a = one.grasps[i].result;
      const GraspResult& b = other.grasps[i].result;
      EXPECT_EQ(a.status, b.status);
      EXPECT_EQ(one.grasps[i].refinements, other.grasps[i].refinements);
      ASSERT_EQ(a.contacts.size(), b.contacts.size());
      for (std::size_t k = 0; k < a.contacts.size(); ++k) {
        EXPECT_EQ(a.contacts[k].p_OC, b.contacts[k].p_OC);
      }
      ASSERT_EQ(a.kinematics.has_value(), b.kinematics.has_value());
      if (a.kinematics) {
        EXPECT_EQ(a.kinematics->ik.q, b.kinematics->ik.q);
      }
    }
  }
}

TEST_F(GraspCompletionTest, FixedContactsStayWhereTheyAre) {
  ASSERT_FALSE(found_.empty());
  const std::vector<GraspContact> fixed = {found_[0].contacts[1]};
  const ContactPlaces places(world_, world_.StartPoses());
  const CompletedGrasp grasp = CompleteGrasp(
      places, {}, {Disturb(found_[0], 0.006, Rng(3)), Rng(3, RngStream::kTest)}, fixed);
  ASSERT_TRUE(grasp.result.uses(fixed[0].finger));
  for (const GraspContact& contact : grasp.result.contacts) {
    if (contact.finger == fixed[0].finger) {
      EXPECT_EQ(contact.p_OC, fixed[0].p_OC);
    }
  }
}

TEST_F(GraspCompletionTest, PointsThatFallTogetherDoNotFailForWantOfRoom) {
  std::vector<GeneratedGrasp> generated;
  for (int i = 0; i < 5; ++i) {
    GeneratedGrasp grasp{{}, Rng(i, RngStream::kTest)};
    grasp.points.fill(Vector3(0.03, 0.003 * i, 0.08));
    generated.push_back(grasp);
  }
  for (const CompletedGrasp& grasp : Complete(generated, 2).grasps) {
    EXPECT_NE(grasp.raw.status, GraspStatus::kTipsTooClose);
    EXPECT_NE(grasp.raw.status, GraspStatus::kNoPlace);
  }
}

TEST(CompletionEffortTest, WhereNoSetHoldsNothingIsRefined) {
  // A card flat on a table: fingers can only press on its top.
  const GraspWorld world(FlatScene({0.2, 0.25, 0.003}, 0.03, -0.01), ShadowHand());
  const ContactPlaces places(world, world.StartPoses());
  std::vector<GeneratedGrasp> generated;
  for (int i = 0; i < 20; ++i) {
    GeneratedGrasp grasp{{}, Rng(i, RngStream::kTest)};
    Rng rng(i);
    for (Vector3& p : grasp.points) p = Vector3(rng.Uniform(-0.1, 0.1), rng.Uniform(-0.1, 0.1), 0);
    generated.push_back(grasp);
  }
  ThreadPool pool(2);
  const CompletionResult result = CompleteGrasps(places, {}, generated, {}, pool);
  EXPECT_TRUE(result.hopeless);
  EXPECT_EQ(result.probes, CompletionConfig().max_probes);
  for (const CompletedGrasp& grasp : result.grasps) {
    EXPECT_EQ(grasp.refinements, 0);
    EXPECT_EQ(grasp.result.status, GraspStatus::kNoInternalForces);
    EXPECT_FALSE(grasp.result.kinematics.has_value());
  }
}

TEST(CompletionEffortTest, AFingerWithoutAPlaceIsNamed) {
  // A rod in a slot 19 mm wide: the thumb's sphere does not fit in, the other fingers' do.
  Scene scene = MakeScene("rod", Box{{0.12, 0.006, 0.02}}, 0.05, Shift(0, 0, 0.01));
  for (const double side : {-1.0, 1.0}) {
    scene.bodies.push_back(FixedBox("wall", {0.6, 0.1, 0.2}, {0, side * (0.0095 + 0.05), 0.1}));
    scene.bodies.push_back(FixedBox("end", {0.1, 0.02, 0.2}, {side * (0.085 + 0.05), 0, 0.1}));
  }
  scene.bodies.push_back(FixedBox("floor", {0.6, 0.6, 0.02}, {0, 0, -0.01}));
  const GraspWorld world(scene, ShadowHand());
  const ContactPlaces places(world, world.StartPoses());
  ASSERT_EQ(places.count(Finger::kThumb), 0);
  ASSERT_GT(places.count(Finger::kIndex), 0);
  GeneratedGrasp generated{{}, Rng(1, RngStream::kTest)};
  generated.points.fill(Vector3(0, 0, 0.01));
  const CompletedGrasp grasp = CompleteGrasp(places, {}, generated, {});
  EXPECT_EQ(grasp.result.status, GraspStatus::kNoPlace);
  EXPECT_EQ(grasp.result.fault.finger, Finger::kThumb);
  EXPECT_FALSE(grasp.feasible());
}

TEST_F(GraspCompletionTest, ABadConfigurationIsBadInput) {
  CompletionConfig config;
  config.max_refinement = -1.0;
  EXPECT_THROW(config.Validate(), InputError);
  config = {};
  config.patience = 0;
  EXPECT_THROW(config.Validate(), InputError);
}

}  // namespace
}  // namespace pregrasp
