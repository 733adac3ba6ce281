#include "app/trajectory/proposals.h"

#include <gtest/gtest.h>

#include "tests/trajectory/ruler_fixture.h"

namespace pregrasp {
namespace {

class ProposalTest : public testing::Test {
 protected:
  RelativePlan Draw(Proposal kind, std::uint64_t seed) const {
    Rng rng(seed);
    return space_.Decode(DrawProposal(space_, kind, Matrix3::Identity(), Vector3::UnitZ(), rng));
  }
  static int CountOn(const RelativePlan& plan) {
    return plan.stages[0][0].on + plan.stages[0][1].on;
  }

  const RulerProblem ruler_;
  const ActionRange range_ = MakeActionRange(ruler_.scene, 0.03);
  // Both fingers on the front side, an upright face: triangles 2 and 3 of a strip.
  const int node_ = 2 * ruler_.graph.num_triangles() + 3;
  const ActionSpace space_{ruler_.graph, {node_, node_}, ruler_.shape, range_, 4};
};

TEST_F(ProposalTest, OneFingerPushesAloneAndTwoPinchAndBothStayOn) {
  for (int kind = 0; kind < kNumProposals; ++kind) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const RelativePlan plan = Draw(static_cast<Proposal>(kind), seed);
      EXPECT_EQ(CountOn(plan), static_cast<Proposal>(kind) == Proposal::kPinch ? 2 : 1);
      for (int finger = 0; finger < kNumPlanningFingers; ++finger) {
        EXPECT_EQ(plan.stages[1][finger].kept, plan.stages[0][finger].on);
      }
    }
  }
}

TEST_F(ProposalTest, APushIsTheSameInEveryKnotAndWithinItsRanges) {
  for (int kind = 0; kind < kNumProposals; ++kind) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const RelativePlan plan = Draw(static_cast<Proposal>(kind), seed);
      for (const FingerStage& finger : plan.stages[0]) {
        for (const FingerStage::Knot& knot : finger.knots) {
          EXPECT_EQ(knot.depth, finger.knots[0].depth);
          EXPECT_EQ(knot.travel_W, finger.knots[0].travel_W);
          EXPECT_LE(knot.depth, range_.max_depth);
          EXPECT_LE(knot.tangent.norm(), range_.cone * knot.depth + 1e-12);
        }
      }
    }
  }
}

TEST_F(ProposalTest, ALiftGoesUpAndPullsUpNearTheConesLimit) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const RelativePlan plan = Draw(Proposal::kLift, seed);
    for (const FingerStage& finger : plan.stages[0]) {
      if (!finger.on) continue;
      const FingerStage::Knot& knot = finger.knots[0];
      const Matrix3 R_OC = FrameFromNormal(finger.contact.nhat_O);
      const Vector3 pull = R_OC * Vector3(knot.tangent.x(), knot.tangent.y(), 0.0);
      EXPECT_GE(pull.z(), 0.65 * range_.cone * knot.depth);
      EXPECT_GE(knot.travel_W.z(), 0.0);
      EXPECT_LE(knot.travel_W.dot(finger.contact.nhat_O), 1e-12);  // never off the object
    }
  }
}

}  // namespace
}  // namespace pregrasp
