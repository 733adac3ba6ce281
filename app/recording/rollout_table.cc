#include "app/recording/rollout_table.h"

#include "app/core/text.h"

namespace pregrasp {
namespace {

void AppendNames(std::string& out, const std::string& stem) {
  for (const char* axis : {"_x", "_y", "_z"}) out.append(",").append(stem).append(axis);
}

void Append(std::string& out, double value) { out.append(",").append(FormatDouble(value)); }

void Append(std::string& out, const Vector3& v) {
  for (int i = 0; i < 3; ++i) Append(out, v[i]);
}

}  // namespace

std::string RolloutHeader(const Scene& scene) {
  std::string header = "t";
  for (const Body& body : scene.bodies) {
    if (!body.movable()) continue;
    const std::string prefix = &body == scene.bodies.data() ? "" : body.name + '_';
    AppendNames(header, prefix + "p_WO");
    header.append(",").append(prefix).append("q_WO_w");
    AppendNames(header, prefix + "q_WO");
    AppendNames(header, prefix + "w_WO");
    AppendNames(header, prefix + "v_WO");
  }
  for (int i = 0; i < kNumPlanningFingers; ++i) {
    const std::string prefix = std::string(kFingerNames[i]) + '_';
    header.append(",").append(prefix).append("on");
    for (const char* stem : {"p_OC", "target_W", "f_W"}) AppendNames(header, prefix + stem);
  }
  return header + '\n';
}

std::string RolloutRow(const WorldState& state) {
  std::string row = FormatDouble(state.t);
  for (const BodyState& body : state.bodies) {
    Append(row, body.p_WB);
    Append(row, body.q_WB.w());
    Append(row, Vector3(body.q_WB.vec()));
    Append(row, body.w_WB);
    Append(row, body.v_WB);
  }
  for (int i = 0; i < kNumPlanningFingers; ++i) {
    const FingertipState& finger = state.fingers[static_cast<std::size_t>(i)];
    row.append(finger.on ? ",1" : ",0");
    Append(row, finger.p_OC);
    Append(row, finger.p_WTarget);
    Append(row, finger.f_W);
  }
  return row + '\n';
}

}  // namespace pregrasp
