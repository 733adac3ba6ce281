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

// The time and the movable bodies, which both tables begin with.
std::string BodyHeader(const Scene& scene) {
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
  return header;
}

std::string BodyColumns(const WorldState& state) {
  std::string row = FormatDouble(state.t);
  for (const BodyState& body : state.bodies) {
    Append(row, body.p_WB);
    Append(row, body.q_WB.w());
    Append(row, Vector3(body.q_WB.vec()));
    Append(row, body.w_WB);
    Append(row, body.v_WB);
  }
  return row;
}

void AppendFingerNames(std::string& header, int finger) {
  const std::string prefix = std::string(kFingerNames[finger]) + '_';
  header.append(",").append(prefix).append("on");
  for (const char* stem : {"p_OC", "n_OC", "target_W", "f_W"}) AppendNames(header, prefix + stem);
}

void AppendFinger(std::string& row, const FingertipState& finger) {
  row.append(finger.on ? ",1" : ",0");
  Append(row, finger.p_OC);
  Append(row, finger.nhat_O);
  Append(row, finger.p_WTarget);
  Append(row, finger.f_W);
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
  for (int f = 0; f < kNumFingers; ++f) {
    AppendFingerNames(header, f);
    header.append(",").append(kFingerNames[f]).append("_k");
    header.append(",").append(kFingerNames[f]).append("_b");
  }
  return header + '\n';
}

std::string LiftRow(const WorldState& state) {
  std::string row = BodyColumns(state);
  for (const FingertipState& finger : state.fingers) {
    AppendFinger(row, finger);
    Append(row, finger.stiffness);
    Append(row, finger.damping);
  }
  return row + '\n';
}

}  // namespace pregrasp
