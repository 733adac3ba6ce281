#include "app/pictures/reasons.h"

#include <gtest/gtest.h>

#include <cmath>

#include "app/core/error.h"

namespace pregrasp {
namespace {

IterationFacts TwoRollouts() {
  IterationFacts facts;
  facts.mean_cost = 0.1;
  for (const double slip : {0.6, 0.0}) {
    RolloutFacts rollout;
    rollout.cost.reward = 0.2;
    rollout.cost.terms = {{"slip", slip}};
    rollout.cost.total = slip - 0.2;
    facts.rollouts.push_back(rollout);
  }
  return facts;
}

TEST(ReasonsTest, ARolloutIsExplainedByWhatSetsItApart) {
  const IterationFacts facts = TwoRollouts();
  EXPECT_EQ(FindBestRollout(facts), 2);
  const Explanation best = ExplainRollout(facts, 2);
  EXPECT_EQ(best.verdict, "best");
  EXPECT_NE(best.text.find("Cheaper than the mean: slip by 0.300."), std::string::npos)
      << best.text;
  const Explanation other = ExplainRolloutAgainst(facts, 1, 2);
  EXPECT_EQ(other.verdict, "dearer");
  EXPECT_EQ(other.text, "Rollout 1 costs 0.400, rollout 2 -0.200; dearer: slip by 0.600");
  EXPECT_THROW(ExplainRollout(facts, 3), InputError);
}

TEST(ReasonsTest, ACertificateIsExplainedByTheBoundThatItBreaks) {
  Scene scene;
  scene.bodies.resize(1);
  scene.bodies[0].name = "book";
  CertifyFacts facts;
  facts.reasons = {"the object moves on in the hold"};
  facts.hold_shift_mm = 12.5;
  const Explanation why = ExplainCertificate(scene, facts, {});
  EXPECT_EQ(why.verdict, "not_certified");
  EXPECT_EQ(why.text,
            "Not certified: the object moves on in the hold; hold shift is 12.50 mm, at most 10 is "
            "allowed");
  EXPECT_EQ(why.items[0].met, false);
  facts.hold_shift_mm = std::nan("");
  EXPECT_EQ(ExplainCertificate(scene, facts, {}).items[0].met, false);
}

TEST(ReasonsTest, GraspsAreCountedByWhatStandsInTheirWay) {
  GraspFacts collides, feasible;
  collides.status = "collision";
  collides.colliding = {"thumb", "table"};
  feasible.feasible = true;
  feasible.status = "feasible";
  LiftFacts lift;
  lift.reasons = {"gives_way"};
  EXPECT_EQ(ExplainGrasps({{&collides, nullptr}, {&collides, nullptr}}).text,
            "None of 2 grasps is feasible. 2 collision (most often thumb and table)");
  const Explanation one = ExplainGrasps({{&collides, nullptr}, {&feasible, &lift}});
  EXPECT_EQ(one.verdict, "none_lifts");
  EXPECT_NE(one.text.find("Lifts fail as: gives way (1)"), std::string::npos) << one.text;
  EXPECT_EQ(ExplainGrasps({}).verdict, "none");
}

TEST(ReasonsTest, PathsOfOneOrderAreExplainedByWhatTheOrderGoesBy) {
  PathFacts first, second;
  first.rank = 1;
  first.order = second.order = "explore";
  first.value = 1.0;
  first.terms = second.terms = {0.3, 0.5};
  first.score = second.score = 0.8;
  second.rank = 2;
  second.value = 0.5;
  second.repeats = 1.0;
  EXPECT_EQ(ExplainOrder(second, first).verdict, "behind");
  EXPECT_NE(ExplainOrder(second, first).text.find("0.500 against 1.000"), std::string::npos);
  EXPECT_EQ(ExplainOrder(first, first).verdict, "same");
  EXPECT_EQ(ExplainPath(second).items[1].name, "repeats");
}

TEST(ReasonsTest, AFrameSaysWhatItGaveUp) {
  FrameFacts frame;
  frame.frame = 7;
  frame.phase = "contact";
  frame.loosened = "tip_5mm";
  frame.tip_error_mm = 2.0;
  const Explanation why = ExplainFrame(frame, {});
  EXPECT_EQ(why.verdict, "tip_5mm");
  EXPECT_NE(why.text.find("with tip 5mm loosened"), std::string::npos) << why.text;
  EXPECT_EQ(why.items[0].met, false);
  frame.way_clear = false;
  frame.failed = true;
  EXPECT_NE(ExplainFrame(frame, {}).text.find("the way from the frame before"), std::string::npos);
}

}  // namespace
}  // namespace pregrasp
