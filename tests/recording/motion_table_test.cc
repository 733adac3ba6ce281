#include "app/recording/motion_table.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace pregrasp {
namespace {

TEST(MotionTableTest, ARowHasAFieldForEveryNameOfTheHeader) {
  MotionFrameTask task;
  task.t = 0.5;
  task.X_WB = {MakeTransform(Matrix3::Identity(), Vector3(1.0, 2.0, 3.0))};
  task.contacts[1].on = true;
  MotionFrame frame;
  frame.clearance = 0.002;
  frame.rung = LooseningRung::kCone80;
  const std::string header = MotionHeader(), row = MotionRow(task, frame);
  EXPECT_EQ(std::count(header.begin(), header.end(), ','), std::count(row.begin(), row.end(), ','));
  EXPECT_EQ(header.rfind("t,p_WO_x,p_WO_y,p_WO_z,q_WO_w,", 0), 0U);
  EXPECT_NE(header.find(",FFJ4,FFJ3,"), std::string::npos);
  EXPECT_EQ(row.rfind("0.5,1,2,3,1,0,0,0,0,0,0,1,", 0), 0U) << row;
  const std::string tail = ",0,1,0,0,0,2,0,2\n";  // flags, clearance_mm, tip_error_mm, loosened
  EXPECT_EQ(row.substr(row.size() - tail.size()), tail) << row;
}

}  // namespace
}  // namespace pregrasp
