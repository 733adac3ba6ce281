#pragma once

#include <array>
#include <vector>

#include "app/graph/placement.h"
#include "app/scene/finger.h"

namespace pregrasp {

/// What one finger does in one contact stage.
struct FingerStage {
  bool on = false;
  /// True if the finger was on in the stage before and keeps its contact; `contact` is then unused.
  bool kept = false;
  Placement::Contact contact;
  /// One a knot; see ForceTarget.
  struct Knot {
    double depth = 0.0;                  ///< spring deflection along the inward normal [m]
    Vector2 tangent = Vector2::Zero();   ///< deflection along the contact's tangents [m]
    Vector3 travel_W = Vector3::Zero();  ///< further movement of the target in the knot [m]
  };
  std::vector<Knot> knots;
};

/// A plan relative to the contacts: what MPPI samples. At the start of each knot the spring's
/// target for the knot's end is set to
///   p_WTarget = p_WC + R_WC (tangent, -depth) + travel_W,
/// with p_WC and R_WC (z outward) where the contact is at that moment, and the target moves there
/// on a straight line. Deflections are springs of the paper's law; re-anchoring them at each knot
/// keeps them inside the friction cone however far the object has come, which free world targets do
/// not.
struct RelativePlan {
  std::vector<std::array<FingerStage, kNumPlanningFingers>> stages;
};

/// The same plan with its targets in the world, as the paper has them: what is certified, logged
/// and replayed.
struct WorldPlan {
  struct Finger {
    bool on = false;
    bool kept = false;
    Placement::Contact contact;
    std::vector<Vector3> p_WTargets;  ///< at the end of each knot; a straight line in between
  };
  std::vector<std::array<Finger, kNumPlanningFingers>> stages;
};

/// How long things last in a plan.
struct PlanTiming {
  double stage_seconds = 0.8;  ///< of one contact stage (findings: .4 to 1.3 all work)
  int knots = 4;               ///< K, force targets a stage
  /// Before a stage that puts a finger on a new contact, the hand is given `transfer_seconds` +
  /// the fingertip's way / `transfer_speed`; fingers that are kept hold their last targets.
  double transfer_seconds = 0.3;
  double transfer_speed = 0.15;  ///< [m/s]
  /// The last targets are held this long before the last score: as long as a certificate does, so
  /// that what creeps away is not found out then.
  double hold_seconds = 1.5;
};

}  // namespace pregrasp
