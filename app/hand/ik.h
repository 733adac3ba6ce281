#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/core/rng.h"
#include "app/hand/distance.h"
#include "app/hand/hand_model.h"
#include "app/hand/way.h"
#include "app/scene/scene.h"

namespace pregrasp {

/// What counts as a solution, and how hard to look for one. The bounds are those of kinematic
/// feasibility in the project's definitions; the search's numbers are measured (tests/bench).
struct IkConfig {
  double tip_tolerance = 5e-4;  ///< a fingertip may be this far from touching its contact [m]
  double tip_target = 1e-4;     ///< what the solvers aim for [m]: a tenth of a millimetre is below
                                ///< every other error of a grasp
  double max_cone_deg = 60.0;   ///< between distal +z and the inward normal; 180 asks nothing. From
                                ///< the paper
  double min_clearance = 0.0;   ///< everywhere but at the contacts [m]
  double contact_depth = 1e-3;  ///< how far a contacting distal link may enter the object [m]: its
                                ///< capsule is rounder than a finger pad
  bool collision = true;        ///< false ignores all bodies and the hand itself: a fast reject
  bool certify = true;          ///< FCL must find every solution free; else the search goes on

  int max_starts = 20;  ///< initial postures tried. 3 finds most; 20 leaves about one of twenty
                        ///< solvable three-finger sets unfound, 100 hardly any
  int start_candidates =
      20;                   ///< random postures aligned to the contacts per start; the best is used
  int max_iterations = 60;  ///< of damped least squares, per start
  bool slsqp = true;        ///< let SLSQP take over where least squares stalls near a solution
  int slsqp_evaluations = 60;  ///< of it, per takeover

  /// Slack asked of clearances beyond what is required [m], so that a solution does not end on the
  /// boundary.
  double clearance_buffer = 6e-4;
  /// SLSQP sees pairs nearer than this [m]. Neighbouring fingers at rest are 2.6 mm apart.
  double influence = 3e-3;
  /// Starts spent on telling why there is no solution, for each demand; without any, the status is
  /// the first demand that the best attempt misses.
  int reason_starts = 3;
  int warm_starts = 5;  ///< of max_starts, how many begin at a given warm start, all but the first
                        ///< perturbed by a few centimetres and a third of a radian

  void Validate() const;
};

/// A fingertip's place: p_WC on the object's surface, nhat_W its outward normal.
struct IkContact {
  Finger finger = Finger::kThumb;
  Vector3 p_WC = Vector3::Zero();
  Vector3 nhat_W = Vector3::UnitZ();
};

struct IkProblem {
  /// None to five, no finger twice. None asks for a free pose near the reference.
  std::vector<IkContact> contacts;
  /// Fingers without a contact that are on their way to one or from one: their distal links may
  /// enter the object as far as those of contacting fingers.
  std::array<bool, kNumFingers> may_touch{};
  /// One pose for each of the solver's bodies, the object first; not used without bodies.
  std::vector<RigidTransform> X_WB;
  /// The first start, before any random one.
  std::optional<HandConfiguration> warm_start;
  /// Stay near this configuration; without it, fingers without a contact are drawn to the
  /// hand's posture.
  std::optional<HandConfiguration> reference;
  /// Of the reference, against 1 mm of tip error: one unit is 5 cm, half a radian of the wrist,
  /// half a radian of a joint.
  double reference_weight = 1.0;
};

/// kSolved, or the first demand that could not be met: each is searched for without those after it.
enum class IkStatus {
  kSolved,
  kTipError,      ///< the fingertips do not reach their contacts
  kCone,          ///< they do, but not within the cones
  kCollision,     ///< they do that too, but not without overlap
  kNotCertified,  ///< the only solutions found were denied by FCL
  kJointLimits,   ///< only from Evaluate: a joint beyond its limits
};
const char* IkStatusName(IkStatus status);

enum class IkMethod { kNone, kLeastSquares, kSlsqp };
const char* IkMethodName(IkMethod method);

inline constexpr double kClearanceSeen = 0.02;  ///< [m]

/// A solution, or the best attempt and what is wrong with it.
struct IkResult {
  IkStatus status = IkStatus::kTipError;
  RigidTransform X_WH = RigidTransform::Identity();
  HandJoints q = HandJoints::Zero();
  /// By Finger; 0 for a finger without a contact.
  std::array<double, kNumFingers> tip_errors{};   ///< [m]
  std::array<double, kNumFingers> cone_angles{};  ///< [rad]
  double tip_error = 0.0;                         ///< the largest [m]
  double cone_angle = 0.0;                        ///< the largest [rad]
  /// Least distance over all pairs but contacting distal links with the object [m], kClearanceSeen
  /// if none is closer; `closest` is that pair.
  double clearance = 0.0;
  std::optional<HandDistance> closest;
  double contact_overlap = 0.0;  ///< of contacting distal links with the object, the largest [m]
  std::optional<HandDistance> deepest_contact;  ///< that pair
  IkMethod method = IkMethod::kNone;            ///< whose result it is
  int starts = 0;                               ///< initial postures used
  int iterations = 0;                           ///< of least squares, all starts
  int evaluations = 0;                          ///< of SLSQP, all takeovers
  int denied = 0;                               ///< solutions that FCL denied

  bool solved() const { return status == IkStatus::kSolved; }
  HandConfiguration configuration() const { return {X_WH, q}; }
};

/// Single-frame inverse kinematics of the free 28-dof hand among bodies: fingertip spheres touch
/// their contacts, distal axes lie in their cones, nothing overlaps. Damped least squares from
/// aligned random postures; NLopt's SLSQP takes over stalls (measured against alternatives in
/// tests/bench/hand_bench.cc). Immutable, safe to share between threads; a result is a function of
/// its arguments alone.
class IkSolver {
 public:
  /// Without bodies: only the hand itself can be in the way.
  explicit IkSolver(const HandModel& hand);
  /// Among a scene's bodies, in scene order.
  IkSolver(const HandModel& hand, const Scene& scene);
  /// Among loaded shapes, the object first.
  IkSolver(const HandModel& hand, const std::vector<const Shape*>& shapes);
  ~IkSolver();
  IkSolver(IkSolver&&) noexcept;

  /// @param rng  of stream kIk, keyed by what the problem is for.
  /// @throws Interrupted between starts.
  IkResult Solve(const IkConfig& config, const IkProblem& problem, Rng rng) const;

  /// The measures of Solve's result for a given configuration, and whether it is a solution.
  IkResult Evaluate(const IkConfig& config, const IkProblem& problem,
                    const HandConfiguration& configuration) const;

  /// Whether the hand comes to no overlap on a way among the solver's bodies (CheckWay).
  WayResult CheckWay(const HandWay& way) const;

  const HandModel& hand() const;

 private:
  friend class IkResiduals;
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace pregrasp
