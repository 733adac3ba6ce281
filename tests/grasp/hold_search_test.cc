#include "app/grasp/hold_search.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/grasp/grasp_scenes.h"

namespace pregrasp {
namespace {

class HoldSearchTest : public ::testing::Test {
 protected:
  HoldSearchTest() : world_(FreeRulerScene(), ShadowHand()), places_(world_, world_.StartPoses()) {}

  bool Holds(const std::vector<GraspContact>& contacts) const {
    return CalcForceStatus(world_, config_, contacts, Matrix3::Identity()) ==
           GraspStatus::kFeasible;
  }
  bool Run(const std::vector<GraspContact>& contacts, const std::vector<GraspContact>& fixed,
           std::vector<GraspContact>* held) const {
    const auto choices = FindChoices(places_, contacts, fixed, 0.010);
    HoldSearch search(world_, config_, choices, Matrix3::Identity());
    ContactChoice choice(contacts.size(), 0);
    const bool holds = search.Run(choice);
    *held = ToContacts(choices, choice);
    return holds;
  }

  GraspWorld world_;
  ContactPlaces places_;
  GraspConfig config_;
};

TEST_F(HoldSearchTest, AThumbOutsideItsFingersComesBetweenThem) {
  // About the middle: the thumb on top presses beyond the fingers below, so that every push turns
  // the ruler the same way.
  const std::vector<GraspContact> contacts = {OnRulerFace(Finger::kThumb, 1, 0.031, 0.0),
                                              OnRulerFace(Finger::kIndex, -1, 0.022, 0.0),
                                              OnRulerFace(Finger::kMiddle, -1, -0.022, 0.0)};
  ASSERT_FALSE(Holds(contacts));
  std::vector<GraspContact> held;
  ASSERT_TRUE(Run(contacts, {}, &held));
  EXPECT_TRUE(Holds(held));
  int moved = 0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const double way = (held[i].p_OC - contacts[i].p_OC).norm();
    EXPECT_LE(way, 0.010 + 1e-12);
    moved += way > 0.0;
  }
  EXPECT_GE(moved, 1);
  EXPECT_LE(moved, 2);
}

TEST_F(HoldSearchTest, AContactThatPressesIsNotMoved) {
  const std::vector<GraspContact> contacts = {OnRulerFace(Finger::kThumb, 1, 0.031, 0.0),
                                              OnRulerFace(Finger::kIndex, -1, 0.022, 0.0),
                                              OnRulerFace(Finger::kMiddle, -1, -0.022, 0.0)};
  std::vector<GraspContact> held;
  ASSERT_TRUE(Run(contacts, {contacts[0]}, &held));
  EXPECT_EQ(held[0].p_OC, contacts[0].p_OC);
  EXPECT_TRUE(Holds(held));
  EXPECT_GT((held[1].p_OC - contacts[1].p_OC).norm() + (held[2].p_OC - contacts[2].p_OC).norm(),
            0.0);
}

TEST_F(HoldSearchTest, ASetThatHoldsStaysAsItIs) {
  const std::vector<GraspContact> contacts = {OnRulerFace(Finger::kThumb, 1, 0.0, 0.0),
                                              OnRulerFace(Finger::kIndex, -1, 0.022, 0.0),
                                              OnRulerFace(Finger::kMiddle, -1, -0.022, 0.0)};
  ASSERT_TRUE(Holds(contacts));
  std::vector<GraspContact> held;
  ASSERT_TRUE(Run(contacts, {}, &held));
  for (std::size_t i = 0; i < contacts.size(); ++i) EXPECT_EQ(held[i].p_OC, contacts[i].p_OC);
}

TEST_F(HoldSearchTest, WhereNothingWithinReachHoldsItSaysSo) {
  // All on top, in the middle of a wide card: the underside is 10 cm away.
  Scene scene = FlatScene({0.2, 0.25, 0.003}, 0.03, 0.0);
  const GraspWorld card(scene, ShadowHand());
  const ContactPlaces places(card, card.StartPoses());
  const std::vector<GraspContact> contacts = {OnRulerFace(Finger::kThumb, 1, 0.0, -0.02),
                                              OnRulerFace(Finger::kIndex, 1, 0.0, 0.02),
                                              OnRulerFace(Finger::kMiddle, 1, 0.03, 0.0)};
  const auto choices = FindChoices(places, contacts, {}, 0.010);
  HoldSearch search(card, config_, choices, Matrix3::Identity());
  ContactChoice choice(contacts.size(), 0);
  EXPECT_FALSE(search.Run(choice));
}

TEST_F(HoldSearchTest, MostSetsThatRandomMovesRepairAreRepaired) {
  // Random sets on both faces that do not hold; 300 random moves of all contacts by up to 10 mm say
  // which can be repaired.
  int repairable = 0, repaired = 0;
  for (int i = 0; i < 60; ++i) {
    Rng rng(i);
    std::vector<GraspContact> contacts;
    for (const Finger finger : {Finger::kThumb, Finger::kIndex, Finger::kMiddle}) {
      contacts.push_back(OnRulerFace(finger, finger == Finger::kThumb ? 1 : -1,
                                     rng.Uniform(-0.05, 0.05), rng.Uniform(-0.01, 0.01)));
    }
    if (!(FindNearestTips(TipSpheres{}, contacts).gap >= 0.0) || Holds(contacts)) continue;
    const auto choices = FindChoices(places_, contacts, {}, 0.010);
    bool can = false;
    for (int trial = 0; trial < 300 && !can; ++trial) {
      ContactChoice choice;
      for (const ContactChoices& each : choices) {
        choice.push_back(
            static_cast<int>(rng.UniformInt(static_cast<std::uint32_t>(each.places.size()))));
      }
      can = Holds(ToContacts(choices, choice));
    }
    repairable += can;
    std::vector<GraspContact> held;
    const bool holds = Run(contacts, {}, &held);
    if (holds) {
      EXPECT_TRUE(Holds(held));
    }
    repaired += can && holds;
  }
  ASSERT_GT(repairable, 8);
  EXPECT_GE(repaired, 0.8 * repairable);
}

}  // namespace
}  // namespace pregrasp
