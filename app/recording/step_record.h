#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/core/math.h"
#include "app/scene/finger.h"

namespace pregrasp {

/// One recorded step: the unit of the log, of steps.jsonl and of the pictures, all under the same
/// id.
struct StepRecord {
  std::string id;     ///< "scene.start", "sim.12", "graph.prune.1", ..
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
  std::string picture;                                ///< file name under frames/, empty for none
};

}  // namespace pregrasp
