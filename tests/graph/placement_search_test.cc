#include "app/graph/placement_search.h"

#include <gtest/gtest.h>

#include "app/core/error.h"
#include "app/geometry/contact_mesh.h"

namespace pregrasp {
namespace {

// Likes contacts with a large x, two fingers more than one; nothing can be at negative z.
class FarAlongX : public PlacementScorer {
 public:
  std::vector<double> Score(std::span<const Placement> placements) const override {
    std::vector<double> scores;
    for (const Placement& placement : placements) {
      double sum = 0.0;
      for (const Placement::Contact& contact : placement.fingers) {
        if (contact.on) sum += 0.5 + contact.p_OC.x();
      }
      scores.push_back(sum);
    }
    return scores;
  }
  bool IsOccluded(Finger, const Placement::Contact& contact) const override {
    return contact.p_OC.z() < 0.0;
  }
};

class PlacementSearchTest : public testing::Test {
 protected:
  std::vector<Placement> Find(const Placement& fixed, int count) const {
    return FindPlacements(mesh_, shape_, scorer_, fixed, count, config_, Rng(1));
  }

  Shape box_ = Box{{0.20, 0.06, 0.04}};
  TriangleMesh mesh_ = BuildContactMesh(box_, {});
  SignedDistance shape_{box_};
  FarAlongX scorer_;
  PlacementSearchConfig config_;
};

TEST_F(PlacementSearchTest, TheBestComeFirstAndNoneIsNearAnother) {
  const std::vector<Placement> found = Find({}, 12);
  ASSERT_EQ(found.size(), 12U);
  const std::vector<double> scores = scorer_.Score(found);
  for (std::size_t i = 1; i < found.size(); ++i) EXPECT_LE(scores[i], scores[i - 1]);
  EXPECT_GT(found.front().thumb().p_OC.x(), 0.08);
  for (std::size_t i = 0; i < found.size(); ++i) {
    ASSERT_TRUE(found[i].thumb().on && found[i].index().on);
    EXPECT_GE(CalcTipGap(TipSpheres{}, found[i]), 0.0);
    EXPECT_LE((found[i].thumb().p_OC - found[i].index().p_OC).norm(), config_.max_tip_distance);
    for (std::size_t j = 0; j < i; ++j) {
      const double thumb = (found[i].thumb().p_OC - found[j].thumb().p_OC).norm();
      const double index = (found[i].index().p_OC - found[j].index().p_OC).norm();
      EXPECT_GT(std::max(thumb, index), config_.spacing);
    }
  }
}

TEST_F(PlacementSearchTest, ContactsAreOnTheSurfaceWhereAFingertipCanBe) {
  for (const Placement& placement : Find({}, 50)) {
    for (const Placement::Contact& contact : placement.fingers) {
      EXPECT_NEAR(shape_.Calc(contact.p_OC), 0.0, 1e-9);
      EXPECT_GE(contact.p_OC.z(), 0.0);
    }
  }
}

TEST_F(PlacementSearchTest, AFixedContactIsInEveryPlacement) {
  Placement fixed;
  fixed.fingers[1] = {true, Vector3(0.02, 0.0, 0.02), Vector3::UnitZ()};
  const std::vector<Placement> found = Find(fixed, 8);
  ASSERT_FALSE(found.empty());
  for (const Placement& placement : found) {
    EXPECT_EQ(placement.index().p_OC, fixed.index().p_OC);
  }
}

TEST_F(PlacementSearchTest, WithBothFingersFixedThereIsOne) {
  Placement fixed;
  fixed.fingers[0] = {true, Vector3(0.05, -0.03, 0.01), -Vector3::UnitY()};
  fixed.fingers[1] = {true, Vector3(0.05, 0.03, 0.01), Vector3::UnitY()};
  EXPECT_EQ(Find(fixed, 8).size(), 1U);
}

TEST_F(PlacementSearchTest, NoPointsAreOurBug) {
  config_.points = 0;
  EXPECT_THROW(Find({}, 8), InternalError);
}

}  // namespace
}  // namespace pregrasp
