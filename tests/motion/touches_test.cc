#include "app/motion/touches.h"

#include <gtest/gtest.h>

#include <memory>

#include "app/geometry/mass_properties.h"

namespace pregrasp {
namespace {

const Vector3 kCarton(0.06, 0.05, 0.10);

// A carton that stands on a table, in a corner between two walls a finger's width off or farther.
class FindOutOfReachTest : public ::testing::Test {
 protected:
  std::optional<double> Find(double gap, const Vector3& p_OC, double wall_height = 0.10) {
    Scene scene;
    scene.name = "corner";
    const auto add = [&](const char* name, const Vector3& size, const Vector3& p) {
      Body body;
      body.name = name;
      body.shape = Box{size};
      body.X_WB.translation() = p;
      scene.bodies.push_back(body);
    };
    add("carton", kCarton, Vector3(0.0, 0.0, 0.5 * kCarton.z()));
    scene.bodies[0].mass_properties = CalcMassProperties(scene.bodies[0].shape, 0.2);
    add("table", Vector3(0.8, 0.8, 0.04), Vector3(0.0, 0.0, -0.02));
    const double far = 0.5 * kCarton.x() + gap + 0.1;
    add("wall", Vector3(0.2, 0.4, wall_height), Vector3(far, 0.0, 0.5 * wall_height));
    const World world(scene);
    WorldState state = world.InitialState();
    world.PutFinger(state, Finger::kIndex, p_OC);
    std::vector<TraceRow> trace{{state, {}}};
    for (int i = 0; i < 120; ++i) {
      state.t += world.config().dt;
      state.fingers[1].touching = true;
      trace.push_back({state, {}});
    }
    const IkSolver solver(ShadowHand(), scene);
    return FindOutOfReach(solver, IkConfig(), world, trace, Rng(1, RngStream::kTest));
  }
};

TEST_F(FindOutOfReachTest, WhereTheTipFitsButNoFingerFollowsItIsSaidWhen) {
  const Vector3 low(0.5 * kCarton.x(), 0.0, -0.04);  // near the table, on the wall's side
  EXPECT_FALSE(Find(0.15, low).has_value());
  EXPECT_EQ(Find(0.019, low), 1.0 / 240);  // the sphere is 18 mm thick; the hand is above the wall
}

TEST_F(FindOutOfReachTest, TheTopIsInReachHoweverNearTheWall) {
  EXPECT_FALSE(Find(0.001, Vector3(0.0, 0.0, 0.5 * kCarton.z())).has_value());
}

TEST(FindTouchesTest, OnlyFingersThatTouchHaveContactsAndShortGapsAreBridged) {
  std::vector<TraceRow> trace(241);
  for (std::size_t i = 0; i < trace.size(); ++i) {
    FingertipState& tip = trace[i].state.fingers[0];
    trace[i].state.t = static_cast<double>(i) / 240.0;
    tip.on = i > 0;
    tip.touching = (i > 10 && i <= 60) || (i > 80 && i <= 100) || (i > 160 && i <= 200);
  }
  const std::vector<Contacts> touches = FindTouches(trace);
  for (std::size_t i = 0; i < trace.size(); ++i) {
    const bool expected = (i > 0 && i <= 100) || (i > 160 && i <= 200);
    EXPECT_EQ(touches[i][0].on, expected) << i;
    EXPECT_FALSE(touches[i][1].on);
  }
}

}  // namespace
}  // namespace pregrasp
