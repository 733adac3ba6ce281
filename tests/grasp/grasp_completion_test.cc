#include "app/grasp/grasp_completion.h"

#include <gtest/gtest.h>

#include <limits>

#include "app/core/error.h"
#include "app/grasp/grasp_search.h"
#include "tests/grasp/grasp_scenes.h"

namespace pregrasp {
namespace {

// A feasible grasp of a ruler that stands over the edge, disturbed: what a generator gives.
class GraspCompletionTest : public ::testing::Test {
 protected:
  GraspCompletionTest() : scene_(RulerScene(0.06)), world_(scene_, ShadowHand()) {
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

  Scene scene_;
  GraspWorld world_;
  std::vector<GraspResult> found_;
};

TEST_F(GraspCompletionTest, WhatItCallsFeasibleIsOnTheSurfaceAndWithinTheMovesAllowed) {
  ASSERT_FALSE(found_.empty());
  constexpr int kTries = 24;
  int feasible = 0;
  for (std::size_t i = 0; i < kTries; ++i) {
    const CompletedGrasp grasp =
        CompleteGrasp(world_, CompletionConfig(), Disturb(found_[i % found_.size()], 0.002, Rng(i)),
                      {}, world_.StartPoses(), Rng(i, RngStream::kTest));
    EXPECT_LE(grasp.moved, 0.010);
    feasible += grasp.feasible();
    for (const GraspContact& contact : grasp.result.contacts) {
      EXPECT_NEAR(world_.object().Calc(contact.p_OC), 0.0, 1e-9);
    }
    if (grasp.feasible()) {
      EXPECT_TRUE(TestContacts(world_, GraspConfig(), grasp.result.contacts, world_.StartPoses(),
                               Rng(99 + i, RngStream::kTest), nullptr)
                      .wrench->feasible());
    }
  }
  EXPECT_GT(feasible, 0);
}

TEST_F(GraspCompletionTest, FixedContactsStayWhereTheyAre) {
  ASSERT_FALSE(found_.empty());
  const std::vector<GraspContact> fixed = {found_[0].contacts[1]};
  const CompletedGrasp grasp =
      CompleteGrasp(world_, CompletionConfig(), Disturb(found_[0], 0.006, Rng(3)), fixed,
                    world_.StartPoses(), Rng(3, RngStream::kTest));
  for (const GraspContact& contact : grasp.result.contacts) {
    if (contact.finger == fixed[0].finger) {
      EXPECT_EQ(contact.p_OC, fixed[0].p_OC);
    }
  }
}

TEST_F(GraspCompletionTest, ARefinementOfNoLengthIsOurBug) {
  ASSERT_FALSE(found_.empty());
  for (const double length : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
    CompletionConfig config;
    config.max_refinement = length;
    EXPECT_THROW(CompleteGrasp(world_, config, Disturb(found_[0], 0.006, Rng(3)), {},
                               world_.StartPoses(), Rng(3, RngStream::kGrasp)),
                 InternalError);
  }
}

}  // namespace
}  // namespace pregrasp
