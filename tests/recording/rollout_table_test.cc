#include "app/recording/rollout_table.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <vector>

#include "app/core/error.h"
#include "tests/recording/sample_run.h"

namespace pregrasp {
namespace {

std::vector<std::string> Split(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line.substr(0, line.size() - 1));
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

// A row by the names of the header.
std::map<std::string, double> ReadRow(const std::string& header, const std::string& row) {
  const std::vector<std::string> names = Split(header), cells = Split(row);
  EXPECT_EQ(names.size(), cells.size());
  std::map<std::string, double> values;
  for (std::size_t i = 0; i < names.size(); ++i) {
    EXPECT_TRUE(values.emplace(names[i], std::strtod(cells.at(i).c_str(), nullptr)).second);
  }
  return values;
}

Vector3 VectorOf(const std::map<std::string, double>& row, const std::string& stem) {
  return {row.at(stem + "_x"), row.at(stem + "_y"), row.at(stem + "_z")};
}

TEST(RolloutTableTest, TheLiftsTableHasAllFiveFingersWithTheirSpringsToTheLastBit) {
  const std::string header = LiftHeader(SampleScene());
  for (int i = 0; i < 6; ++i) {
    const WorldState state = SampleState(i);
    const auto row = ReadRow(header, LiftRow(SampleScene(), state));
    EXPECT_EQ(row.at("t"), state.t);
    EXPECT_EQ(VectorOf(row, "p_WO"), state.bodies[0].p_WB);
    EXPECT_EQ(row.at("q_WO_w"), state.bodies[0].q_WB.w());
    for (int f = 0; f < kNumFingers; ++f) {
      const std::string name = kFingerNames[f];
      const FingertipState& tip = state.fingers[f];
      EXPECT_EQ(row.at(name + "_on"), tip.on ? 1.0 : 0.0);
      EXPECT_EQ(VectorOf(row, name + "_p_OC"), tip.p_OC);
      EXPECT_EQ(VectorOf(row, name + "_n_OC"), tip.nhat_O);
      EXPECT_EQ(VectorOf(row, name + "_target_W"), tip.p_WTarget);
      EXPECT_EQ(VectorOf(row, name + "_f_W"), tip.f_W);
      EXPECT_EQ(row.at(name + "_k"), tip.stiffness);
      EXPECT_EQ(row.at(name + "_b"), tip.damping);
    }
  }
}

TEST(RolloutTableTest, BodiesAndContactsAreReadBackFromBothTables) {
  const Scene scene = SampleScene();
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "table.csv";
  for (const bool lift : {false, true}) {
    std::ofstream out(file);
    out << (lift ? LiftHeader(scene) : RolloutHeader(scene));
    for (int i = 0; i < 3; ++i) {
      out << (lift ? LiftRow(SampleScene(), SampleState(i)) : RolloutRow(SampleState(i)));
    }
    out.close();
    const std::vector<BodyRow> rows = ReadBodyRows(file, scene);
    ASSERT_EQ(rows.size(), 3U);
    for (int i = 0; i < 3; ++i) {
      const WorldState state = SampleState(i);
      EXPECT_EQ(rows[i].t, state.t);
      ASSERT_EQ(rows[i].X_WB.size(), state.bodies.size());
      for (std::size_t b = 0; b < state.bodies.size(); ++b) {
        EXPECT_TRUE(rows[i].X_WB[b].isApprox(state.bodies[b].X_WB(), 1e-12)) << b;
      }
      std::size_t read = 0;
      for (int f = 0; f < (lift ? kNumFingers : kNumPlanningFingers); ++f) {
        if (!state.fingers[f].on) continue;
        ASSERT_LT(read, rows[i].contacts.size());
        const BodyRow::Contact& contact = rows[i].contacts[read++];
        EXPECT_EQ(static_cast<int>(contact.finger), f);
        EXPECT_EQ(contact.p_OC, state.fingers[f].p_OC);
        EXPECT_EQ(contact.nhat_O, state.fingers[f].nhat_O);
        EXPECT_EQ(contact.f_W, state.fingers[f].f_W);
      }
      EXPECT_EQ(read, rows[i].contacts.size());
    }
  }
}

TEST(RolloutTableTest, ADamagedTableIsNamedWithItsLine) {
  const Scene scene = SampleScene();
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "table.csv";
  std::ofstream(file) << RolloutHeader(scene) << "0,1,2,x,1,0,0,0\n";
  try {
    ReadBodyRows(file, scene);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_EQ(error.where(), file.string() + ":2");
    EXPECT_EQ(error.got(), "x");
  }
  std::ofstream(file) << "t,x\n";
  EXPECT_THROW(ReadBodyRows(file, scene), InputError);
}

TEST(RolloutTableTest, TheRolloutsTableHasTheLiftsColumnsOfThumbAndIndexButForTheirSprings) {
  const WorldState state = SampleState(3);
  const auto rollout = ReadRow(RolloutHeader(SampleScene()), RolloutRow(state));
  const auto lift = ReadRow(LiftHeader(SampleScene()), LiftRow(SampleScene(), state));
  for (const auto& [name, value] : rollout) EXPECT_EQ(lift.at(name), value) << name;
  EXPECT_EQ(lift.size() - rollout.size(), 3U * 15U + 2U * 2U);
}

}  // namespace
}  // namespace pregrasp
