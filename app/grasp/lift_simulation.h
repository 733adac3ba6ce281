#pragma once

#include <optional>
#include <vector>

#include "app/dynamics/neighbours.h"
#include "app/dynamics/world.h"
#include "app/grasp/grasp_stiffness.h"
#include "app/grasp/grasp_world.h"
#include "app/grasp/lift_way.h"

namespace pregrasp {

struct LiftConfig {
  LiftWayConfig way;
  GraspForcesConfig forces;
  double handover_seconds = 0.1;  ///< in which fingers that leave their contacts let go
  double closing_seconds = 0.6;   ///< in which the grasp's forces rise
  double lift_seconds = 1.2;      ///< for the first `way.height`; a longer way takes longer
  double hold_seconds = 0.5;

  void Validate() const;
};

/// What a grasp is lifted with: its contacts and forces, each finger's spring.
struct LiftGrip {
  std::vector<GraspContact> contacts;
  MatrixX3 forces_O;       ///< on the object, in its frame [N], #contacts x 3
  double stiffness = 0.0;  ///< k [N/m]
};

/// Why a lift does not hold.
enum class LiftReason {
  kNoFreeDirection,  ///< nothing from up to level is free for 10 cm
  kNeverFree,        ///< the object never comes free of its surroundings
  kNoForces,         ///< no forces inside the cones balance the weight at the contacts
  kGivesWay,         ///< the grasp's stiffness is not positive definite with a margin
  kDiverged,         ///< the object left the scene
  kTipOverlap,       ///< a fingertip sphere enters the surroundings by more than 0.3 mm
  kDoesNotFollow,    ///< the object is over 1 cm or 15 degrees from where it should be
  kStillTouches,     ///< something but fingers touches the object at the end
  kNotConverged,     ///< contact forces were not found to the accuracy that a verdict needs
  kStepDependent,    ///< half the time step gives another verdict
};
/// "no_free_direction", ..: the word used in logs and scripts.
const char* LiftReasonName(LiftReason reason);

/// What a simulated lift, or a push at its top, did. Every number is finite.
struct LiftOutcome {
  double height = 0.0;        ///< how far the object came along the way's direction [m]
  double shift = 0.0;         ///< the farthest it was from where it should be, at any step [m]
  double turn_deg = 0.0;      ///< the most that it turned, at any step [degrees]
  double end_shift = 0.0;     ///< the same at the end [m]
  double end_turn_deg = 0.0;  ///< [degrees]
  double slip = 0.0;          ///< the farthest that a fingertip slid while it was on [m]
  double tip_overlap = 0.0;   ///< deepest overlap of a fingertip sphere with the surroundings [m]
  Finger deepest_tip = Finger::kThumb;
  /// One that touched the object in the last 0.3 s.
  std::optional<BodyIndex> touching_body;
  NeighbourMotion neighbours;         ///< at the end
  double neighbour_moved = 0.0;       ///< the farthest that one was from its start, at any step [m]
  double neighbour_turned_deg = 0.0;  ///< the most that one had turned, at any step [degrees]
  bool diverged = false;
  int not_converged = 0;    ///< physics steps that the contact solver left unfinished
  double unresolved = 0.0;  ///< the overlap that these may have left, summed [m]

  /// When closing, lift and hold begin [s].
  double closing_t = 0.0, lift_t = 0.0, hold_t = 0.0;
  WorldState end;
  std::vector<TraceRow> trace;  ///< every step, the start first, if it was asked for
};

/// The design's "held" of one simulation; empty if it holds.
std::vector<LiftReason> JudgeLift(const LiftOutcome& outcome);

/// Whether the grasp has withstood a push: at the end the object is again within the bounds of a
/// lift, and fingers alone hold it.
bool WithstandsPush(const LiftOutcome& outcome);

/// Lifts: hand-over, closing, lift, hold. Fingers that press in `start` where the grip uses them
/// take its stiffness, their targets moved so that the force is continuous; others let go. Then the
/// targets of all go in straight lines to where the springs give the grip's forces, and along the
/// way.
/// @param trace  whether to keep every step.
LiftOutcome SimulateLift(const World& world, const EnvironmentDistance& environment,
                         const WorldState& start, const LiftGrip& grip, const LiftWay& way,
                         const LiftConfig& config, Stepper stepper, bool trace);

/// Pushes the object that is held in `top`, in its centre of mass, for 0.3 s, and lets it come to
/// rest for 0.5 s.
LiftOutcome SimulatePush(const World& world, const EnvironmentDistance& environment,
                         const WorldState& top, const Vector3& force_W);

/// The contacts with those that a finger presses already, less than 2 mm away, where it presses.
std::vector<GraspContact> MoveToPressing(const WorldState& state,
                                         std::vector<GraspContact> contacts);

}  // namespace pregrasp
