#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "app/scene/finger.h"
#include "app/scene/scene.h"

namespace pregrasp {

// Replays a run in MuJoCo from its own files alone: scene.json, rollout.csv, lift.csv. The scene's
// bodies as their convex pieces, the fingers as outer forces by the law that
// app/dynamics/README.md states; nothing of app/dynamics is used.

/// One row of rollout.csv or lift.csv.
struct ReplayRow {
  struct FingerColumns {
    bool on = false;
    Vector3 p_OC = Vector3::Zero(), n_OC = Vector3::UnitZ();
    Vector3 target_W = Vector3::Zero(), f_W = Vector3::Zero();
    double k = 0.0, b = 0.0;  ///< [N/m], [N s/m]
  };
  double t = 0.0;                    ///< [s]
  std::vector<RigidTransform> X_WB;  ///< of the movable bodies, the object first
  std::array<FingerColumns, kNumFingers> fingers;
};

/// @throws InputError for a file that is not such a table of the scene's.
std::vector<ReplayRow> ReadReplayTable(const std::filesystem::path& file, const Scene& scene);

struct ReplayResult {
  std::vector<RigidTransform> X_WO;  ///< of the object, by row of the table
  int touching_body = -1;  ///< scene index of what touched the object in the last 0.3 s; -1: none
};

/// @param dt  of MuJoCo [s]; light objects on springs of 300 N/m are unstable at 2 ms.
ReplayResult ReplayInMujoco(const Scene& scene, const std::vector<ReplayRow>& rows, double dt);

/// The object's poses in the table itself.
std::vector<RigidTransform> ObjectPoses(const std::vector<ReplayRow>& rows);

/// The verdict on a lift, from its table and the object's pose at each row: within 1 cm and 15
/// degrees of where it should be at all of them, touched by nothing at the end. It should be where
/// it was until the fingers' targets begin to go together, and then go with them.
struct ReplayVerdict {
  bool held = false;
  double shift = 0.0;     ///< the farthest from where it should be [m]
  double turn_deg = 0.0;  ///< the most [degrees]
  bool is_close = false;  ///< within 20 % of a limit: counted apart
};
ReplayVerdict JudgeReplay(const std::vector<ReplayRow>& rows,
                          const std::vector<RigidTransform>& X_WO, int touching_body);

}  // namespace pregrasp
