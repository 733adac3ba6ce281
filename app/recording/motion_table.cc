#include "app/recording/motion_table.h"

#include <sstream>

#include "app/core/error.h"
#include "app/core/text.h"
#include "app/recording/checked_file.h"
#include "app/recording/csv_cells.h"

namespace pregrasp {
namespace {

using internal::AppendCell;
using internal::AppendCells;

void AppendPoseNames(std::string& out, const std::string& frame) {
  internal::AppendVectorNames(out, "p_W" + frame);
  internal::AppendQuaternionNames(out, "q_W" + frame);
}

MotionPhase ReadPhase(const std::string& where, const std::string& word) {
  for (int phase = 0; phase < kNumMotionPhases; ++phase) {
    if (word == MotionPhaseName(static_cast<MotionPhase>(phase))) {
      return static_cast<MotionPhase>(phase);
    }
  }
  throw InputError(where, "phase", "approach, contact, transit, closing or lift", word);
}

MotionRecord ReadRow(const HandModel& hand, const std::string& where, const std::string& line) {
  internal::CellReader cells(where, line);
  MotionRecord record;
  record.t = cells.NextNumber();
  record.X_WO = cells.NextPose();
  record.hand.X_WH = cells.NextPose();
  for (int j = 0; j < hand.num_joints; ++j) record.hand.q[j] = cells.NextNumber();
  for (int f = 0; f < hand.num_fingers; ++f) record.on[f] = cells.NextChoice(1) == 1;
  record.phase = ReadPhase(where, cells.NextWord("a phase"));
  record.clearance_mm = cells.NextNumber();
  record.tip_error_mm = cells.NextNumber();
  record.rung = static_cast<LooseningRung>(cells.NextChoice(kNumLooseningRungs - 1));
  record.simulated_t = cells.NextNumber();
  cells.ExpectEnd();
  return record;
}

}  // namespace

std::string MotionHeader(const HandModel& hand) {
  std::string header = "t";
  AppendPoseNames(header, "O");
  AppendPoseNames(header, "H");
  for (int j = 0; j < hand.num_joints; ++j) header.append(",").append(hand.joints[j].name);
  for (int f = 0; f < hand.num_fingers; ++f)
    header.append(",").append(kFingerNames[f]).append("_on");
  return header + ",phase,clearance_mm,tip_error_mm,loosened,simulated_t\n";
}

std::string MotionRow(const HandModel& hand, const MotionFrameTask& task,
                      const MotionFrame& frame) {
  std::string row = FormatDouble(task.t);
  AppendCells(row, task.X_WB.front());
  AppendCells(row, frame.configuration.X_WH);
  for (int j = 0; j < hand.num_joints; ++j) AppendCell(row, frame.configuration.q[j]);
  for (int f = 0; f < hand.num_fingers; ++f) row.append(task.contacts[f].on ? ",1" : ",0");
  row.append(",").append(MotionPhaseName(task.phase));
  AppendCell(row, 1e3 * frame.clearance);
  AppendCell(row, 1e3 * frame.tip_error);
  row.append(",").append(
      std::to_string(static_cast<int>(frame.failed() ? LooseningRung::kFailed : frame.rung)));
  AppendCell(row, task.simulated_t);
  return row + '\n';
}

std::vector<MotionRecord> ReadMotionTable(const std::filesystem::path& file,
                                          const HandModel& hand) {
  std::istringstream lines(ReadFile(file));
  std::string line;
  std::getline(lines, line);
  if (line + '\n' != MotionHeader(hand)) {
    throw InputError(file.string() + ":1", "", "the header of a motion.csv of this hand",
                     OneLine(line));
  }
  std::vector<MotionRecord> records;
  for (int number = 2; std::getline(lines, line); ++number) {
    records.push_back(ReadRow(hand, file.string() + ':' + std::to_string(number), line));
  }
  return records;
}

}  // namespace pregrasp
