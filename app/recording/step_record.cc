#include "app/recording/step_record.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/core/json_reader.h"
#include "app/core/json_values.h"

namespace pregrasp {

std::string PictureName(int number, const std::string& id) {
  std::string name = id;
  std::replace(name.begin(), name.end(), '.', '-');
  return fmt::format("{:04}_{}.png", number, name);
}

nlohmann::ordered_json StepToJson(const StepRecord& step, int number) {
  nlohmann::ordered_json bodies = nlohmann::ordered_json::array();
  for (const StepRecord::BodyPose& body : step.bodies) {
    bodies.push_back({{"name", body.name},
                      {"p_WB", ToJson(Vector3(body.X_WB.translation()))},
                      {"q_WB", QuaternionJson(body.X_WB.linear())}});
  }
  nlohmann::ordered_json fingers = nlohmann::ordered_json::array();
  for (const StepRecord::FingerContact& contact : step.fingers) {
    fingers.push_back({{"finger", FingerName(contact.finger)},
                       {"on", contact.on},
                       {"p_OC", ToJson(contact.p_OC)},
                       {"p_WTarget", ToJson(contact.p_WTarget)},
                       {"f_W", ToJson(contact.f_W)}});
  }
  return {{"number", number},
          {"id", step.id},
          {"stage", step.stage},
          {"t", step.t},
          {"bodies", std::move(bodies)},
          {"fingers", std::move(fingers)},
          {"picture", "frames/" + PictureName(number, step.id)},
          {"details", step.details}};
}

StepRecord StepFromJson(const nlohmann::json& value, const std::string& where) {
  const JsonReader reader(value, where);
  StepRecord step;
  step.id = reader["id"].Text();
  step.stage = reader["stage"].Text();
  step.t = reader["t"].Number();
  const JsonReader bodies = reader["bodies"];
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    step.bodies.push_back({bodies[i]["name"].Text(),
                           MakeTransform(bodies[i]["q_WB"].Quat(), bodies[i]["p_WB"].Vec3())});
  }
  const JsonReader fingers = reader["fingers"];
  for (std::size_t i = 0; i < fingers.size(); ++i) {
    const JsonReader name = fingers[i]["finger"];
    const auto found = std::find(kFingerNames.begin(), kFingerNames.end(), name.Text());
    if (found == kFingerNames.end()) name.Fail("the name of a finger");
    step.fingers.push_back({static_cast<Finger>(found - kFingerNames.begin()),
                            fingers[i]["on"].Bool(), fingers[i]["p_OC"].Vec3(),
                            fingers[i]["p_WTarget"].Vec3(), fingers[i]["f_W"].Vec3()});
  }
  step.details = reader["details"].json();
  return step;
}

}  // namespace pregrasp
