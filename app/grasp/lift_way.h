#pragma once

#include <vector>

#include "app/geometry/point_cloud.h"
#include "app/geometry/signed_distance.h"

namespace pregrasp {

struct LiftWayConfig {
  double height = 0.10;  ///< of the way [m]
  /// The way goes on until the object is free, at most this far [m].
  double max_length = 0.60;
  double rise = 0.02;       ///< then so far up [m]
  double clearance = 5e-3;  ///< free: at the end of the rise, nothing is nearer than this [m]

  void Validate() const;
};

enum class LiftWayStatus {
  kFree,
  kNoFreeDirection,  ///< in every direction from up to level, something is in the way
  kNeverFree,        ///< the object never comes free of its surroundings
};

/// The way of a lift: a straight line, and another one up if it does not go up.
struct LiftWay {
  LiftWayStatus status = LiftWayStatus::kNoFreeDirection;
  bool is_free() const { return status == LiftWayStatus::kFree; }

  Vector3 direction_W = Vector3::UnitZ();  ///< unit
  double length = 0.0;                     ///< along it [m]
  Vector3 rise_W = Vector3::Zero();        ///< then along this [m]
};

/// The way of a lift: in the direction nearest to up in which the object comes as far as `height`
/// without meeting its surroundings, and farther on, until it is free of them; straight up is taken
/// even where it does not become so. Among directions a degree apart: tilts of 0, 1, .. 90 degrees,
/// azimuths a degree of arc apart on each ring, ties by azimuth. The object is its cloud's points,
/// each followed continuously along the way; a point may graze the surroundings by 1 mm.
/// @param X_WB   of all bodies, the object first.
/// @param up_W   unit, against gravity.
LiftWay FindLiftWay(const std::vector<RigidTransform>& X_WB, const PointCloud& cloud,
                    const EnvironmentDistance& environment, const Vector3& up_W,
                    const LiftWayConfig& config);

}  // namespace pregrasp
