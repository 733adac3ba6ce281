#include "app/training/grasp_growth.h"

#include <gtest/gtest.h>

#include <memory>

#include "app/geometry/mass_properties.h"
#include "app/training/make_item.h"

namespace pregrasp {
namespace {

// A carton on a table, its front end over the edge, and what grows on it.
class GraspGrowthTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    Scene scene;
    scene.name = "carton";
    Body object;
    object.name = "object";
    object.shape = Box{{0.16, 0.07, 0.03}};
    object.X_WB = MakeTransform(Matrix3::Identity(), Vector3(0.0, 0.0, 0.015));
    object.mass_properties = CalcMassProperties(object.shape, 0.1);
    Body table;
    table.name = "table";
    table.shape = Box{{0.8, 0.8, 0.04}};
    table.X_WB = MakeTransform(Matrix3::Identity(), Vector3(-0.38, 0.0, -0.02));
    scene.bodies = {object, table};
    world = std::make_unique<GraspWorld>(MakeTrainingWorld(scene));
    config.max_tests = 30;
    config.search.max_found = 3;
    config.search.max_sets = 6000;
    ThreadPool pool(2);
    grown = GrowGrasps(*world, config, world->StartPoses(), 11, pool);
  }
  static void TearDownTestSuite() { world.reset(); }

  static std::unique_ptr<GraspWorld> world;
  static GrowthConfig config;
  static GrowthResult grown;
};
std::unique_ptr<GraspWorld> GraspGrowthTest::world;
GrowthConfig GraspGrowthTest::config;
GrowthResult GraspGrowthTest::grown;

TEST_F(GraspGrowthTest, EveryGraspPassesTheTestAgain) {
  ASSERT_GE(grown.grasps.size(), 5);
  for (const GrownGrasp& grasp : grown.grasps) {
    const GraspResult test =
        TestContacts(*world, config.search.grasp, grasp.contacts, world->StartPoses(),
                     Rng(1, RngStream::kTest), &grasp.hand);
    EXPECT_TRUE(test.feasible()) << Explain(test);
    for (const GraspContact& contact : grasp.contacts) {
      EXPECT_NEAR(world->object().Calc(contact.p_OC), 0.0, 1e-6);
    }
  }
}

TEST_F(GraspGrowthTest, SomeGrowFromSeedsAndAllDiffer) {
  int seeds = 0;
  for (std::size_t i = 0; i < grown.grasps.size(); ++i) {
    const auto& a = grown.grasps[i].contacts;
    seeds += grown.grasps[i].seed;
    for (std::size_t k = 0; k < i; ++k) {
      const auto& b = grown.grasps[k].contacts;
      bool same = a.size() == b.size();
      for (std::size_t c = 0; same && c < a.size(); ++c) {
        same = a[c].finger == b[c].finger && (a[c].p_OC - b[c].p_OC).norm() < config.spacing;
      }
      EXPECT_FALSE(same) << i << " " << k;
    }
  }
  EXPECT_GT(seeds, 0);
  EXPECT_GT(static_cast<int>(grown.grasps.size()), seeds);
}

// A grasp that works beside the table works with the table farther away: what makes a label fall
// as the surroundings come near.
TEST_F(GraspGrowthTest, AGraspSurvivesRelief) {
  const MatrixX3& P_O = world->surface().P;
  for (const double relief : {0.005, 0.01, 0.02, 0.04}) {
    const auto X_WB = MoveSurroundingsAway(world->scene(), P_O, relief);
    for (const GrownGrasp& grasp : grown.grasps) {
      const GraspResult test = TestContacts(*world, config.search.grasp, grasp.contacts, X_WB,
                                            Rng(1, RngStream::kTest), &grasp.hand);
      EXPECT_TRUE(test.feasible()) << relief << ": " << Explain(test);
    }
  }
}

TEST_F(GraspGrowthTest, TheNumberOfThreadsDoesNotMatter) {
  ThreadPool one(1);
  const GrowthResult again = GrowGrasps(*world, config, world->StartPoses(), 11, one);
  ASSERT_EQ(again.grasps.size(), grown.grasps.size());
  for (std::size_t i = 0; i < grown.grasps.size(); ++i) {
    ASSERT_EQ(again.grasps[i].contacts.size(), grown.grasps[i].contacts.size());
    for (std::size_t k = 0; k < again.grasps[i].contacts.size(); ++k) {
      EXPECT_EQ(again.grasps[i].contacts[k].p_OC, grown.grasps[i].contacts[k].p_OC);
    }
  }
}

}  // namespace
}  // namespace pregrasp
