#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/dynamics/world.h"
#include "app/scene/scene.h"

namespace pregrasp {

/// The first line of rollout.csv, with its line break: t, then for the object p_WO_*, q_WO_*
/// (w, x, y, z), w_WO_* and v_WO_*, then the same prefixed NAME_ for each other movable body in
/// scene order, then for each planning finger FINGER_on (0 or 1), FINGER_p_OC_*, FINGER_n_OC_* (the
/// outward normal there, in the object's frame), FINGER_target_W_* and FINGER_f_W_* (on the
/// object). SI units; numbers are the shortest text that reads back as the same double.
std::string RolloutHeader(const Scene& scene);

/// One line of it.
std::string RolloutRow(const WorldState& state);

/// The same for lift.csv, of all of the hand's fingers, each with FINGER_k and FINGER_b behind the
/// others: stiffness [N/m] and damping [N s/m] of its spring. Of a finger that is off, all are 0
/// but for the z of the normal.
std::string LiftHeader(const Scene& scene);
std::string LiftRow(const Scene& scene, const WorldState& state);

/// Where the movable bodies are at a row of either table.
struct BodyRow {
  double t = 0.0;                    ///< [s]
  std::vector<RigidTransform> X_WB;  ///< the object first, in scene order
  /// Contacts of the fingers that are on, with the object's outward normal and the force on it.
  struct Contact {
    Finger finger = Finger::kThumb;
    Vector3 p_OC = Vector3::Zero(), nhat_O = Vector3::UnitZ();
    Vector3 f_W = Vector3::Zero();  ///< [N]
  };
  std::vector<Contact> contacts;
};

/// Bodies and contacts of a rollout.csv or lift.csv. @throws InputError with the file, its line and
/// what was expected.
std::vector<BodyRow> ReadBodyRows(const std::filesystem::path& file, const Scene& scene);

}  // namespace pregrasp
