#include "app/recording/motion_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
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

// The fields of one line, in turn.
class FieldReader {
 public:
  FieldReader(std::string where, const std::string& line) : where_(std::move(where)), line_(line) {}

  std::string NextWord(const char* expected) {
    if (!(at_ <= line_.size())) throw InputError(where_, "", expected, "the end of the line");
    const std::size_t end = std::min(line_.find(',', at_), line_.size());
    const std::string word = line_.substr(at_, end - at_);
    at_ = end + 1;
    return word;
  }

  double NextNumber() {
    const std::string word = NextWord("a number");
    double value = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) {
      throw InputError(where_, "", "a finite number", word);
    }
    return value;
  }

  // A whole number from 0 to `most`.
  int NextChoice(int most) {
    const double value = NextNumber();
    const auto choice = static_cast<int>(value);
    if (!(value >= 0.0 && value <= most && value == choice)) {
      throw InputError(where_, "", "a whole number from 0 to " + std::to_string(most),
                       FormatDouble(value));
    }
    return choice;
  }

  RigidTransform NextPose() {
    Vector3 p_WF;
    for (int i = 0; i < 3; ++i) p_WF[i] = NextNumber();
    double wxyz[4];
    for (double& value : wxyz) value = NextNumber();
    const Quaternion q_WF(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
    constexpr double kUnit = 1e-6;  // far above what writing a rotation as text loses
    if (!(std::abs(q_WF.norm() - 1.0) <= kUnit)) {
      throw InputError(where_, "", "a unit quaternion", FormatDouble(q_WF.norm()));
    }
    return MakeTransform(q_WF.normalized(), p_WF);
  }

  MotionPhase NextPhase() {
    const std::string word = NextWord("a phase");
    for (int phase = 0; phase < kNumMotionPhases; ++phase) {
      if (word == MotionPhaseName(static_cast<MotionPhase>(phase))) {
        return static_cast<MotionPhase>(phase);
      }
    }
    throw InputError(where_, "phase", "approach, contact, transit, closing or lift", word);
  }

  void ExpectEnd() const {
    if (at_ <= line_.size()) throw InputError(where_, "", "no more fields", line_.substr(at_));
  }

 private:
  std::string where_;
  const std::string& line_;
  std::size_t at_ = 0;
};

MotionRecord ReadRow(const std::string& where, const std::string& line) {
  FieldReader fields(where, line);
  MotionRecord record;
  record.t = fields.NextNumber();
  record.X_WO = fields.NextPose();
  record.hand.X_WH = fields.NextPose();
  for (int j = 0; j < kNumHandJoints; ++j) record.hand.q[j] = fields.NextNumber();
  for (bool& on : record.on) on = fields.NextChoice(1) == 1;
  record.phase = fields.NextPhase();
  record.clearance_mm = fields.NextNumber();
  record.tip_error_mm = fields.NextNumber();
  record.rung = static_cast<LooseningRung>(fields.NextChoice(kNumLooseningRungs - 1));
  record.simulated_t = fields.NextNumber();
  fields.ExpectEnd();
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
