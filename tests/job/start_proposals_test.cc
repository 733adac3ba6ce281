#include "app/job/start_proposals.h"

#include <gtest/gtest.h>

#include "app/core/data_folder.h"
#include "app/job/start_verdict.h"
#include "tests/job/fixture.h"

namespace pregrasp {
namespace {

// What the shipped generator proposes for the ruler with its end `overhang` beyond the edge.
ProposedGrasps Propose(double overhang, std::uint64_t seed, int threads) {
  Scene scene = MakeRulerScene();
  scene.object().X_WB.translation().x() = overhang - 0.150;
  const auto world = std::make_shared<const World>(scene);
  ThreadPool pool(threads);
  return ProposeAtStart({world, ShadowHand(), world->InitialState(), PlannerConfig(), seed, pool,
                         DataFolder() / "assets" / "weights"});
}

TEST(StartProposalsTest, WhereNothingHoldsAllSamplesOfAllNodesAreTested) {
  const ProposedGrasps flat = Propose(-0.010, 1, 2);
  EXPECT_FALSE(flat.feasible.has_value());
  EXPECT_EQ(flat.nodes, kProposedNodes);
  EXPECT_EQ(flat.samples, kProposedNodes * kProposedPerNode);
}

TEST(StartProposalsTest, OfARulerOverTheEdgeTheyAreGraspsTheSameForAnyNumberOfThreads) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const ProposedGrasps one = Propose(0.060, seed, 1);
    ASSERT_TRUE(one.feasible.has_value()) << seed;
    EXPECT_TRUE(one.feasible->feasible());
    EXPECT_EQ(one.samples, one.nodes * kProposedPerNode);
    if (seed > 1) continue;  // one tells about threads
    const ProposedGrasps two = Propose(0.060, seed, 2);
    ASSERT_TRUE(two.feasible.has_value()) << seed;
    EXPECT_EQ(two.nodes, one.nodes);
    ASSERT_EQ(two.feasible->contacts.size(), one.feasible->contacts.size());
    for (std::size_t i = 0; i < one.feasible->contacts.size(); ++i) {
      EXPECT_EQ(two.feasible->contacts[i].p_OC, one.feasible->contacts[i].p_OC);
    }
  }
}

TEST(StartProposalsTest, AVerdictSaysOfHowManyItKnows) {
  StartCertificate start;
  start.mu = 0.8;
  start.proposed_nodes = 10;
  start.proposed_samples = 200;
  start.search.plausible = kLeastWithinReach;
  const std::string searched = DescribeStart(start);
  EXPECT_NE(searched.find("of 200 generated grasps for the 10 best nodes none is feasible"),
            std::string::npos)
      << searched;
}

}  // namespace
}  // namespace pregrasp
