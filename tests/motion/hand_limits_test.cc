#include "app/motion/hand_limits.h"

#include <gtest/gtest.h>

namespace pregrasp {
namespace {

TEST(HandLimitsTest, RatesAreThoseOfAMotionFromRestToRest) {
  // One frame of 2 cm, 0.03 rad about z and 0.05 rad of a joint, then still.
  std::vector<HandConfiguration> motion(4);
  for (std::size_t i = 1; i < motion.size(); ++i) {
    motion[i].X_WH.translation().x() = 0.02;
    motion[i].X_WH.linear() = Eigen::AngleAxisd(0.03, Vector3::UnitZ()).toRotationMatrix();
    motion[i].q[2] = -0.05;
  }
  const double fps = 30.0;
  const HandLimits limits;
  const auto rates = [&](int i) { return CalcRates(ShadowHand(), limits, motion, i, fps); };
  EXPECT_EQ(rates(0).wrist_speed, 0.0);
  EXPECT_NEAR(rates(0).wrist_acceleration, 18.0, 1e-9);
  EXPECT_NEAR(rates(1).wrist_speed, 0.6, 1e-12);
  EXPECT_NEAR(rates(1).wrist_turn_speed, 0.9, 1e-9);
  EXPECT_NEAR(rates(1).joint_speed, 1.5, 1e-12);
  EXPECT_NEAR(rates(1).joint_acceleration, 45.0, 1e-9);
  EXPECT_NEAR(rates(1).speed_share, 1.5 / ShadowHand().joints[2].max_speed, 1e-9);
  EXPECT_NEAR(rates(1).acceleration_share, 18.0 / 5.0, 1e-9);
  EXPECT_FALSE(rates(1).IsWithinLimits());
  EXPECT_TRUE(rates(3).IsWithinLimits());
  HandRates whole;
  for (int i = 0; i < 4; ++i) whole.Include(rates(i));
  EXPECT_NEAR(whole.wrist_turn_acceleration, 27.0, 1e-9);
  EXPECT_NEAR(whole.wrist_speed, 0.6, 1e-12);
}

TEST(HandLimitsTest, ANumberThatIsNoneIsNotWithinLimits) {
  HandRates rates;
  rates.speed_share = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(rates.IsWithinLimits());
}

}  // namespace
}  // namespace pregrasp
