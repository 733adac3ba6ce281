#include "app/trajectory/action.h"

#include <gtest/gtest.h>

#include "tests/trajectory/ruler_fixture.h"

namespace pregrasp {
namespace {

constexpr int kKnots = 4;

TEST(ActionSpaceTest, EveryActionStaysInTheTrianglesTheConeAndTheCap) {
  const RulerProblem ruler;
  const MppiProblem problem = ruler.Make(2, 1);
  const ActionRange range = MakeActionRange(ruler.scene, 0.03);
  const ActionSpace space(ruler.graph, problem.path.nodes, ruler.shape, range, kKnots);
  Rng rng(3);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<double> action(space.size());
    for (double& u : action) u = 3.0 * rng.Normal();
    const RelativePlan plan = space.Decode(action);
    ASSERT_EQ(plan.stages.size(), 2U);
    for (int stage = 0; stage < 2; ++stage) {
      for (const FingerStage& finger : plan.stages[stage]) {
        for (const FingerStage::Knot& knot : finger.knots) {
          EXPECT_GE(knot.depth, 0.0);
          EXPECT_LE(knot.depth * ruler.scene.fingertips.stiffness, 12.0);
          EXPECT_LE(knot.tangent.norm(), 0.9 * 0.8 * knot.depth + 1e-12);
          EXPECT_LE(knot.travel_W.cwiseAbs().maxCoeff(), 0.03);
        }
        if (!finger.on || finger.kept) continue;
        EXPECT_NEAR(finger.contact.p_OC.z(), 0.0015, 1e-9);
        EXPECT_LE(std::abs(finger.contact.p_OC.x()), 0.03 + 1e-9);  // strip 2 of 5
        EXPECT_NEAR(finger.contact.nhat_O.z(), 1.0, 1e-9);
      }
    }
  }
}

TEST(ActionSpaceTest, AFingerMovesOnlyAfterAStageWithoutContact) {
  const RulerProblem ruler;
  const ActionSpace space(ruler.graph, ruler.Make(2, 1).path.nodes, ruler.shape,
                          MakeActionRange(ruler.scene, 0.03), kKnots);
  Rng rng(5);
  int kept = 0;
  for (int trial = 0; trial < 100; ++trial) {
    std::vector<double> action(space.size());
    for (double& u : action) u = rng.Normal();
    const RelativePlan plan = space.Decode(action);
    for (int finger = 0; finger < kNumPlanningFingers; ++finger) {
      EXPECT_FALSE(plan.stages[0][finger].kept);
      const bool both = plan.stages[0][finger].on && plan.stages[1][finger].on;
      EXPECT_EQ(plan.stages[1][finger].kept, both);
      kept += both;
    }
  }
  EXPECT_GT(kept, 10);
}

}  // namespace
}  // namespace pregrasp
