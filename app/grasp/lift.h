#pragma once

#include "app/dynamics/world.h"
#include "app/geometry/point_cloud.h"
#include "app/grasp/feasible_grasp.h"

namespace pregrasp {

struct LiftConfig {
  double height = 0.10;          ///< along the lift's direction [m]
  double closing_seconds = 0.6;  ///< in which the grasp's forces rise
  double lift_seconds = 1.2;
  double hold_seconds = 0.5;
  double friction_reserve = 0.6;  ///< forces are chosen inside this share of the friction cone
  double max_shift = 0.01;        ///< the object may lag behind by this much [m]
  double max_turn_deg = 15.0;     ///< and turn by this much [degrees]
};

/// The design's "lift": closing the grasp and moving the object, with targets under the same spring
/// law as everything else.
struct LiftResult {
  bool held = false;
  Vector3 direction_W = Vector3::UnitZ();
  double height = 0.0;    ///< how far the object came along it [m]
  double shift = 0.0;     ///< from where it should be [m]
  double turn_deg = 0.0;  ///< [degrees]
  double slip = 0.0;      ///< the farthest that a fingertip slid [m]
  WorldState end;
};

/// The direction nearest to up in which the object can move by `height` without meeting the
/// surroundings (up, then rings of directions at 15, 30, .. 90 degrees; ties by azimuth).
Vector3 FindLiftDirection(const World& world, const WorldState& state, const PointCloud& cloud,
                          const EnvironmentDistance& environment, double height);

/// Lifts a feasible grasp from `state`, in which some fingers may press already: those keep contact
/// and target until the grasp's own forces have taken over. The springs are soft: forces above
/// stiffness times the object's half width turn it over, whatever the hand's own stiffness would do
/// (design: lift is reported as it is).
LiftResult SimulateLift(const World& world, const WorldState& state, const GraspWorld& grasp_world,
                        const GraspResult& grasp, const Vector3& direction_W,
                        const LiftConfig& config);

}  // namespace pregrasp
