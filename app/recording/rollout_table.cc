#include "app/recording/rollout_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "app/core/error.h"
#include "app/core/text.h"
#include "app/recording/checked_file.h"
#include "app/recording/csv_cells.h"

namespace pregrasp {
namespace {

using internal::AppendCell;
using internal::AppendCells;
using internal::AppendVectorNames;

// The time and the movable bodies, which both tables begin with.
std::string BodyHeader(const Scene& scene) {
  std::string header = "t";
  for (const Body& body : scene.bodies) {
    if (!body.movable()) continue;
    const std::string prefix = &body == scene.bodies.data() ? "" : body.name + '_';
    AppendVectorNames(header, prefix + "p_WO");
    internal::AppendQuaternionNames(header, prefix + "q_WO");
    AppendVectorNames(header, prefix + "w_WO");
    AppendVectorNames(header, prefix + "v_WO");
  }
  return header;
}

std::string BodyColumns(const WorldState& state) {
  std::string row = FormatDouble(state.t);
  for (const BodyState& body : state.bodies) {
    AppendCells(row, body.p_WB);
    AppendCells(row, body.q_WB);
    AppendCells(row, body.w_WB);
    AppendCells(row, body.v_WB);
  }
  return row;
}

void AppendFingerNames(std::string& header, int finger) {
  const std::string prefix = std::string(kFingerNames[finger]) + '_';
  header.append(",").append(prefix).append("on");
  for (const char* stem : {"p_OC", "n_OC", "target_W", "f_W"})
    AppendVectorNames(header, prefix + stem);
}

void AppendFinger(std::string& row, const FingertipState& finger) {
  row.append(finger.on ? ",1" : ",0");
  AppendCells(row, finger.p_OC);
  AppendCells(row, finger.nhat_O);
  AppendCells(row, finger.p_WTarget);
  AppendCells(row, finger.f_W);
}

}  // namespace

std::string RolloutHeader(const Scene& scene) {
  std::string header = BodyHeader(scene);
  for (int f = 0; f < kNumPlanningFingers; ++f) AppendFingerNames(header, f);
  return header + '\n';
}

std::string RolloutRow(const WorldState& state) {
  std::string row = BodyColumns(state);
  for (int f = 0; f < kNumPlanningFingers; ++f) AppendFinger(row, state.fingers[f]);
  return row + '\n';
}

std::string LiftHeader(const Scene& scene) {
  std::string header = BodyHeader(scene);
  for (int f = 0; f < scene.tips.count; ++f) {
    AppendFingerNames(header, f);
    header.append(",").append(kFingerNames[f]).append("_k");
    header.append(",").append(kFingerNames[f]).append("_b");
  }
  return header + '\n';
}

std::string LiftRow(const Scene& scene, const WorldState& state) {
  std::string row = BodyColumns(state);
  for (int f = 0; f < scene.tips.count; ++f) {
    const FingertipState& finger = state.fingers[f];
    AppendFinger(row, finger);
    AppendCell(row, finger.stiffness);
    AppendCell(row, finger.damping);
  }
  return row + '\n';
}

std::vector<BodyRow> ReadBodyRows(const std::filesystem::path& file, const Scene& scene) {
  std::istringstream lines(ReadFile(file));
  std::string line;
  std::getline(lines, line);
  line += '\n';
  const bool of_plan = line == RolloutHeader(scene);
  if (!of_plan && line != LiftHeader(scene)) {
    throw InputError(file.string() + ":1", "", "the header of such a table of this scene",
                     OneLine(line));
  }
  const auto movables = std::count_if(scene.bodies.begin(), scene.bodies.end(),
                                      [](const Body& body) { return body.movable(); });
  std::vector<BodyRow> rows;
  for (int number = 2; std::getline(lines, line); ++number) {
    const std::string where = fmt::format("{}:{}", file.string(), number);
    internal::CellReader cells(where, line);
    BodyRow row{cells.NextNumber(), {}, {}};
    for (std::ptrdiff_t i = 0; i < movables; ++i) {
      row.X_WB.push_back(cells.NextPose());
      for (int velocity = 0; velocity < 2; ++velocity) cells.NextVector();
    }
    for (int f = 0; f < (of_plan ? kNumPlanningFingers : scene.tips.count); ++f) {
      const bool on = cells.NextNumber() != 0.0;
      BodyRow::Contact contact{static_cast<Finger>(f)};
      contact.p_OC = cells.NextVector();
      contact.nhat_O = cells.NextVector();
      cells.NextVector();  // target
      contact.f_W = cells.NextVector();
      if (!of_plan) {
        for (int more = 0; more < 2; ++more) cells.NextNumber();  // stiffness, damping
      }
      if (on) row.contacts.push_back(contact);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace pregrasp
