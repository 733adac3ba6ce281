#include "app/recording/motion_table.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "app/core/error.h"
#include "app/recording/checked_file.h"
#include "tests/test_folder.h"

namespace pregrasp {
namespace {

TEST(MotionTableTest, ARowHasAFieldForEveryNameOfTheHeader) {
  MotionFrameTask task;
  task.t = 0.5;
  task.simulated_t = 0.25;
  task.phase = MotionPhase::kTransit;
  task.X_WB = {MakeTransform(Matrix3::Identity(), Vector3(1.0, 2.0, 3.0))};
  task.contacts[1].on = true;
  MotionFrame frame;
  frame.clearance = 0.002;
  frame.solved = true;
  frame.rung = LooseningRung::kCone80;
  const std::string header = MotionHeader(ShadowHand()), row = MotionRow(ShadowHand(), task, frame);
  EXPECT_EQ(std::count(header.begin(), header.end(), ','), std::count(row.begin(), row.end(), ','));
  EXPECT_EQ(header.rfind("t,p_WO_x,p_WO_y,p_WO_z,q_WO_w,", 0), 0U);
  EXPECT_NE(header.find(",FFJ4,FFJ3,"), std::string::npos);
  EXPECT_EQ(row.rfind("0.5,1,2,3,1,0,0,0,0,0,0,1,", 0), 0U) << row;
  // flags, phase, clearance_mm, tip_error_mm, loosened, simulated_t
  const std::string tail = ",0,1,0,0,0,transit,2,0,2,0.25\n";
  EXPECT_EQ(row.substr(row.size() - tail.size()), tail) << row;
}

class MotionTableReadTest : public ::testing::Test {
 protected:
  MotionTableReadTest() : file_(folder_.path() / "motion.csv") {}

  // A row of a hand turned and bent, all of whose numbers differ.
  static std::string Row() {
    MotionFrameTask task;
    task.t = 1.0 / 3.0;
    task.simulated_t = 0.7;
    task.phase = MotionPhase::kClosing;
    task.X_WB = {
        MakeTransform(Quaternion(Eigen::AngleAxisd(2.5, Vector3(1.0, 2.0, 3.0).normalized())),
                      Vector3(0.1, -0.2, 0.3))};
    task.contacts[0].on = task.contacts[4].on = true;
    return MotionRow(ShadowHand(), task, Frame());
  }

  static MotionFrame Frame() {
    MotionFrame frame;
    frame.configuration.X_WH =
        MakeTransform(Quaternion(Eigen::AngleAxisd(-1.5, Vector3(3.0, -1.0, 2.0).normalized())),
                      Vector3(0.4, 0.5, -0.6));
    for (int j = 0; j < kMaxHandJoints; ++j) frame.configuration.q[j] = 0.01 * j - 0.05;
    frame.clearance = 1.25e-3;
    frame.tip_error = 2.5e-4;
    frame.rung = LooseningRung::kFailed;
    return frame;
  }

  std::string ErrorOf(const std::string& text) const {
    WriteFile(file_, text);
    try {
      ReadMotionTable(file_, ShadowHand());
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  const TestFolder folder_;
  const std::filesystem::path file_;
};

TEST_F(MotionTableReadTest, WhatWasWrittenIsReadBack) {
  WriteFile(file_, MotionHeader(ShadowHand()) + Row() + Row());
  const std::vector<MotionRecord> records = ReadMotionTable(file_, ShadowHand());
  ASSERT_EQ(records.size(), 2U);
  const MotionRecord& record = records[1];
  EXPECT_EQ(record.t, 1.0 / 3.0);
  EXPECT_EQ(record.phase, MotionPhase::kClosing);
  EXPECT_EQ(record.hand.q, Frame().configuration.q);
  EXPECT_TRUE(record.hand.X_WH.isApprox(Frame().configuration.X_WH, 1e-14));
  EXPECT_TRUE(record.X_WO.translation().isApprox(Vector3(0.1, -0.2, 0.3), 0.0));
  EXPECT_EQ(record.on, (std::array<bool, kNumFingers>{true, false, false, false, true}));
  EXPECT_EQ(record.clearance_mm, 1.25);
  EXPECT_EQ(record.tip_error_mm, 0.25);
  EXPECT_EQ(record.rung, LooseningRung::kFailed);
  EXPECT_EQ(record.simulated_t, 0.7);
}

TEST_F(MotionTableReadTest, WhatIsNoMotionIsRefusedWithItsLine) {
  const std::string row = Row();
  const auto replaced = [&](const std::string& word, const std::string& by) {
    std::string other = row;
    return other.replace(other.find(word), word.size(), by);
  };
  EXPECT_NE(ErrorOf("t,x\n").find("motion.csv:1"), std::string::npos);
  EXPECT_NE(ErrorOf(MotionHeader(ShadowHand()) + row + replaced("closing", "waving"))
                .find("motion.csv:3"),
            std::string::npos);
  EXPECT_NE(ErrorOf(MotionHeader(ShadowHand()) + row.substr(0, row.rfind(','))), "");
  EXPECT_NE(ErrorOf(MotionHeader(ShadowHand()) + row.substr(0, row.size() - 1) + ",0\n"), "");
  EXPECT_NE(ErrorOf(MotionHeader(ShadowHand()) + replaced(",closing,1.25", ",closing,nan")), "");
  EXPECT_NE(ErrorOf(MotionHeader(ShadowHand()) + replaced(",6,0.7", ",7,0.7")),
            "");  // no such rung
  EXPECT_NE(ErrorOf(MotionHeader(ShadowHand()) + replaced(",6,0.7", ",6,soon")), "");
}

}  // namespace
}  // namespace pregrasp
