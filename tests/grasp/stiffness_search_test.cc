#include "app/grasp/stiffness_search.h"

#include <gtest/gtest.h>

#include "tests/grasp/grasp_scenes.h"

namespace pregrasp {
namespace {

class StiffnessSearchTest : public ::testing::Test {
 protected:
  StiffnessSearchTest()
      : world_(FreeRulerScene(), ShadowHand()), places_(world_, world_.StartPoses()) {}

  // Two fingers above and three below, nearly on the ruler's long axis, about which it turns over.
  static std::vector<GraspContact> NearTheAxis() {
    return {OnRulerFace(Finger::kThumb, 1, 0.0, 0.0), OnRulerFace(Finger::kIndex, -1, 0.022, 0.0),
            OnRulerFace(Finger::kMiddle, -1, -0.022, 0.0),
            OnRulerFace(Finger::kRing, -1, 0.0, 0.001),
            OnRulerFace(Finger::kLittle, 1, -0.022, 0.001)};
  }
  bool Holds(const std::vector<GraspContact>& contacts) const {
    return CalcForceStatus(world_, config_, contacts, Matrix3::Identity()) ==
           GraspStatus::kFeasible;
  }
  LeastStiffness CalcLeast(const std::vector<GraspContact>& contacts) const {
    return ChooseGraspForces(world_.ToWrenchContacts(contacts),
                             world_.MakeWrenchConfig(config_.f_min, Matrix3::Identity()),
                             world_.scene().fingertips.grasp_stiffness, forces_)
        ->least;
  }
  bool Run(const std::vector<ContactChoices>& choices, int tests, ContactChoice& choice) const {
    return StiffnessSearch(world_, config_, forces_, choices, Matrix3::Identity(), tests)
        .Run(choice);
  }

  GraspWorld world_;
  ContactPlaces places_;
  GraspConfig config_;
  GraspForcesConfig forces_;
};

TEST_F(StiffnessSearchTest, ContactsInALineArePartedUntilTheRulerDoesNotTurnOver) {
  const std::vector<GraspContact> contacts = NearTheAxis();
  ASSERT_TRUE(Holds(contacts));
  const LeastStiffness before = CalcLeast(contacts);
  ASSERT_LT(before.value, 0.0);
  EXPECT_GT(std::abs(before.turn.x()), 0.9);
  const auto choices = FindChoices(places_, contacts, {}, 0.010);
  ContactChoice choice(contacts.size(), 0);
  ASSERT_TRUE(Run(choices, 40, choice));
  const std::vector<GraspContact> moved = ToContacts(choices, choice);
  EXPECT_TRUE(Holds(moved));
  EXPECT_GE(FindNearestTips(TipSpheres{}, moved).gap, 0.0);
  EXPECT_GT(CalcLeast(moved).value,
            forces_.min_stiffness * world_.scene().fingertips.grasp_stiffness);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    EXPECT_LE((moved[i].p_OC - contacts[i].p_OC).norm(), 0.010 + 1e-12);
  }
}

TEST_F(StiffnessSearchTest, AFingerThatWasLeftOutIsUsedWhereThatMakesItStiff) {
  const std::vector<GraspContact> contacts = NearTheAxis();
  std::vector<GraspContact> fixed = contacts;
  fixed.pop_back();
  const auto choices = FindChoices(places_, contacts, fixed, 0.020);
  ContactChoice choice = {0, 0, 0, 0, kLeftOut};
  ASSERT_TRUE(Run(choices, 40, choice));
  EXPECT_NE(choice[4], kLeftOut);
  EXPECT_TRUE(Holds(ToContacts(choices, choice)));
  EXPECT_EQ(ContactChoice(choice.begin(), choice.end() - 1), ContactChoice(4, 0));
}

TEST_F(StiffnessSearchTest, WithoutAWayOrWithoutTestsTheSetStaysAsItIs) {
  const std::vector<GraspContact> contacts = NearTheAxis();
  ContactChoice choice(contacts.size(), 0);
  EXPECT_FALSE(Run(FindChoices(places_, contacts, contacts, 0.010), 40, choice));
  EXPECT_EQ(choice, ContactChoice(contacts.size(), 0));
  EXPECT_FALSE(Run(FindChoices(places_, contacts, {}, 0.010), 1, choice));
  EXPECT_EQ(choice, ContactChoice(contacts.size(), 0));
}

}  // namespace
}  // namespace pregrasp
