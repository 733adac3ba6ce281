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

MotionRecord ReadRow(const std::string& where, const std::string& line) {
  internal::CellReader cells(where, line);
  MotionRecord record;
  record.t = cells.NextNumber();
  record.X_WO = cells.NextPose();
  record.hand.X_WH = cells.NextPose();
  for (int j = 0; j < kNumHandJoints; ++j) record.hand.q[j] = cells.NextNumber();
  for (bool& on : record.on) on = cells.NextChoice(1) == 1;
  record.phase = ReadPhase(where, cells.NextWord("a phase"));
  record.clearance_mm = cells.NextNumber();
  record.tip_error_mm = cells.NextNumber();
  record.rung = static_cast<LooseningRung>(cells.NextChoice(kNumLooseningRungs - 1));
  record.simulated_t = cells.NextNumber();
  cells.ExpectEnd();
  return record;
}

}  // namespace

std::string MotionHeader() {
  std::string header = "t";
  AppendPoseNames(header, "O");
  AppendPoseNames(header, "H");
  for (const char* joint : kHandJointNames) header.append(",").append(joint);
  for (const char* finger : kFingerNames) header.append(",").append(finger).append("_on");
  return header + ",phase,clearance_mm,tip_error_mm,loosened,simulated_t\n";
}

std::string MotionRow(const MotionFrameTask& task, const MotionFrame& frame) {
  std::string row = FormatDouble(task.t);
  AppendCells(row, task.X_WB.front());
  AppendCells(row, frame.configuration.X_WH);
  for (int j = 0; j < kNumHandJoints; ++j) AppendCell(row, frame.configuration.q[j]);
  for (const Placement::Contact& contact : task.contacts) row.append(contact.on ? ",1" : ",0");
  row.append(",").append(MotionPhaseName(task.phase));
  AppendCell(row, 1e3 * frame.clearance);
  AppendCell(row, 1e3 * frame.tip_error);
  row.append(",").append(
      std::to_string(static_cast<int>(frame.failed() ? LooseningRung::kFailed : frame.rung)));
  AppendCell(row, task.simulated_t);
  return row + '\n';
}

std::vector<MotionRecord> ReadMotionTable(const std::filesystem::path& file) {
  std::istringstream lines(ReadFile(file));
  std::string line;
  std::getline(lines, line);
  if (line + '\n' != MotionHeader()) {
    throw InputError(file.string() + ":1", "", "the header of a motion.csv", OneLine(line));
  }
  std::vector<MotionRecord> records;
  for (int number = 2; std::getline(lines, line); ++number) {
    records.push_back(ReadRow(file.string() + ':' + std::to_string(number), line));
  }
  return records;
}

}  // namespace pregrasp
