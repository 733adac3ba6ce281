#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/core/math.h"
#include "app/scene/finger.h"

namespace pregrasp {

/// One recorded step: the unit of run.rawlog, of steps.jsonl and of the pictures, all under the
/// same id. Steps are numbered from 1 in the order in which they are recorded; a step taken again
/// after going back is recorded again, with the same id and a new number.
struct StepRecord {
  std::string id;     ///< "scene.start", "sim.12", "graph.prune.1", ..; [A-Za-z0-9._-]+
  std::string stage;  ///< "scene", "sim", "graph", "paths", "path", "motion"
  double t = 0.0;     ///< simulated time [s]

  struct BodyPose {
    std::string name;
    RigidTransform X_WB = RigidTransform::Identity();
  };
  std::vector<BodyPose> bodies;  ///< the movable bodies, the object first

  struct FingerContact {
    Finger finger = Finger::kThumb;
    bool on = false;
    Vector3 p_OC = Vector3::Zero(), p_WTarget = Vector3::Zero(), f_W = Vector3::Zero();
  };
  std::vector<FingerContact> fingers;

  nlohmann::json details = nlohmann::json::object();  ///< the stage's own values
};

/// The name under frames/ of the picture of step `number` (from 1): 1 and "scene.start" give
/// "0001_scene-start.png". A function of the step alone, so that the log of a run is the same with
/// and without pictures; the file is there only if a picture was taken.
std::string PictureName(int number, const std::string& id);

/// The step as an object of steps.jsonl (see app/recording/README.md).
nlohmann::ordered_json StepToJson(const StepRecord& step, int number);

/// The reverse. Rotations come back through their quaternion, so within 1e-15; all else exactly.
/// @param where  file and line, for messages. @throws InputError for anything StepToJson does not
/// write.
StepRecord StepFromJson(const nlohmann::json& value, const std::string& where);

}  // namespace pregrasp
