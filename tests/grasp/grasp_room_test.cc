#include "app/grasp/grasp_room.h"

#include <gtest/gtest.h>

#include "tests/grasp/grasp_scenes.h"

namespace pregrasp {
namespace {

std::vector<RigidTransform> Moved(const GraspWorld& world, const RigidTransform& X_WO) {
  std::vector<RigidTransform> X_WB = world.StartPoses();
  X_WB.front() = X_WO;
  return X_WB;
}

TEST(GraspRoomTest, RisesWithEveryStepThatARulerStandsFartherOverTheEdge) {
  const GraspWorld world(RulerScene(-0.010), ShadowHand());
  const GraspRoom room(world, {}, 1);
  ASSERT_GT(room.num_sets(), 100);
  double last = -1.0;
  for (const double overhang : {-0.010, -0.005, 0.0, 0.005, 0.010, 0.020, 0.040, 0.080}) {
    const double value =
        room.Calc(Moved(world, Shift(0.010 + overhang, 0, 0.0015)), std::vector<GraspContact>{});
    EXPECT_GE(value, last) << overhang;
    EXPECT_TRUE(value > last || overhang <= 0.0) << overhang;
    EXPECT_LT(value, 1.0);
    last = value;
  }
  EXPECT_GT(last, 0.1);
}

TEST(GraspRoomTest, RisesAsAFrontIsLiftedAndAsABookIsTiltedOrPulled) {
  const GraspWorld keyboard(KeyboardScene(0.01), ShadowHand());
  const GraspRoom keyboard_room(keyboard, {}, 1);
  const GraspWorld book(BookScene(), ShadowHand());
  const GraspRoom book_room(book, {}, 1);
  double lifted = -1.0, tilted = -1.0;
  for (const double deg : {0.0, 3.0, 8.0, 16.0, 30.0}) {
    const double angle = DegToRad(deg);
    // About the back lower edge; the front goes up.
    const Matrix3 up = RotationFromRpy({0, -angle, 0});
    const Vector3 back(-0.065, 0, 0);
    const RigidTransform X_lift =
        MakeTransform(up, Vector3(back + up * (Vector3(0, 0, 0.010) - back)));
    const double lift = keyboard_room.Calc(Moved(keyboard, X_lift), {});
    EXPECT_GT(lift, lifted) << deg;
    lifted = lift;
    // About the front lower edge, the top comes out.
    const Matrix3 forward = RotationFromRpy({0, angle, 0});
    const Vector3 front(0.0775, 0, 0);
    const RigidTransform X_tilt =
        MakeTransform(forward, Vector3(front + forward * (Vector3(0, 0, 0.115) - front)));
    const double tilt = book_room.Calc(Moved(book, X_tilt), {});
    EXPECT_GT(tilt, tilted) << deg;
    tilted = tilt;
  }
  EXPECT_GT(book_room.Calc(Moved(book, Shift(0.090, 0, 0.115)), {}),
            2.0 * book_room.Calc(book.StartPoses(), {}));
}

TEST(GraspRoomTest, KeptContactsMustHelpToHold) {
  const GraspWorld world(RulerScene(0.080), ShadowHand());
  const GraspRoom room(world, {}, 1);
  const std::vector<RigidTransform> X_WB = world.StartPoses();
  const std::vector<GraspContact> near{{Finger::kIndex, {0.120, 0, 0.0015}, Vector3::UnitZ()}};
  const std::vector<GraspContact> far{{Finger::kIndex, {-0.140, 0, 0.0015}, Vector3::UnitZ()}};
  EXPECT_GT(room.Calc(X_WB, near), 2.0 * room.Calc(X_WB, far));
}

TEST(GraspRoomTest, IsTheSameForTheSameSeedAndNearlySoForAnother) {
  const GraspWorld world(RulerScene(0.040), ShadowHand());
  const std::vector<RigidTransform> X_WB = world.StartPoses();
  const double one = GraspRoom(world, {}, 1).Calc(X_WB, {});
  EXPECT_EQ(one, GraspRoom(world, {}, 1).Calc(X_WB, {}));
  const double other = GraspRoom(world, {}, 2).Calc(X_WB, {});
  EXPECT_NE(one, other);
  EXPECT_NEAR(one, other, 0.1);
}

}  // namespace
}  // namespace pregrasp
