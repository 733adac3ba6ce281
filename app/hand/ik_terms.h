#pragma once

#include <array>
#include <vector>

#include "app/hand/distance.h"
#include "app/hand/hand_kinematics.h"
#include "app/hand/ik.h"

namespace pregrasp::internal {

/// Standard deviations of the residuals: 1 mm of a tip or of clearance weighs as much as .05 of a
/// cone's cosine (measured: they make most first starts succeed).
inline constexpr double kSigmaLength = 1e-3;  ///< [m]
inline constexpr double kSigmaCone = 0.05;
/// Of the pad side's preference (a component of a unit vector) and of a posture [rad]: weak, so
/// that they move a fingertip by hundredths of a millimetre only.
inline constexpr double kSigmaPad = 0.5;
inline constexpr double kSigmaPosture = 0.5;
inline constexpr double kSigmaPostureUsed = 1.5;  ///< for the joints of contacting fingers
/// A solution keeps this much from every boundary [m], above the rounding of two distance
/// libraries.
inline constexpr double kStrictly = 1e-6;

/// A problem prepared for evaluation.
struct IkTerms {
  struct Contact {
    Finger finger;
    int link;
    Vector3 p_LT;       ///< centre of the tip's sphere
    Vector3 p_WTarget;  ///< where it shall be
    Vector3 nhat_W;     ///< outward
  };

  IkTerms(const HandModel& hand, const HandObstacles* obstacles, const IkConfig& config,
          const IkProblem& problem);

  const HandModel& hand;
  const HandObstacles* obstacles;  ///< may be null
  const IkConfig& config;
  HandObstacles::Placed placed;
  TouchRule touch;
  std::array<Contact, kNumFingers> contacts;
  int num_contacts = 0;
  double least_cosine = 0.5;
  double contact_weight = 1.0;  ///< of the squares of tips and cones
  bool has_reference = false;
  HandConfiguration reference;   ///< its joints are the posture if there is no reference
  HandVector reference_weights;  ///< of the squared deviation of each degree of freedom
};

/// A configuration with all that is computed from it.
struct IkPoint {
  HandConfiguration configuration;
  HandPose pose;
  std::vector<HandDistance> near;
  std::array<double, kNumFingers> tip_errors{};  ///< by contact
  std::array<double, kNumFingers> cosines{};     ///< of distal z with the inward normal, by contact
  double max_tip_error = 0.0;
  double min_cosine = 1.0;
  double clearance = 0.0;        ///< least distance that is no touch; the influence if none is near
  double contact_overlap = 0.0;  ///< of touching distal links
  double task_cost = 0.0;        ///< squared residuals of tips, cones and distances
  double cost = 0.0;             ///< and of preferences
};

/// Fills in all but point->configuration and what distances tell. @return point->cost, a lower
/// bound of what it will be.
double CalcContactCost(const IkTerms& terms, IkPoint* point);

/// Then distances up to `influence`, which must not be below LeastSquaresInfluence. Does not
/// allocate once `near` has grown.
void CalcDistances(const IkTerms& terms, double influence, IkPoint* point);

/// Both.
void EvaluatePoint(const IkTerms& terms, double influence, IkPoint* point);

/// The distance below which a pair has a residual.
inline double LeastSquaresInfluence(const IkTerms& terms) {
  return terms.config.min_clearance + terms.config.clearance_buffer;
}

/// Gauss-Newton's J^T J (lower half) and J^T r of `point->cost` (= r^T r).
void CalcNormalEquations(const IkTerms& terms, const IkPoint& point, HandMatrix* JtJ,
                         HandVector* Jtr);

/// Inside all bounds but the tips', which may be up to `tip_error` off.
bool IsSolution(const IkTerms& terms, const IkPoint& point, double tip_error);

/// Damped least squares (Levenberg-Marquardt) from `point`, joints clamped to their limits. Ends
/// when the tips are within config.tip_target of a solution, when it stalls, or after
/// config.max_iterations. @return iterations used. `scratch` is working space.
int SolveLeastSquares(const IkTerms& terms, IkPoint* point, IkPoint* scratch);

/// NLopt's SLSQP from `point`: the nearest configuration (in HandUnits) that puts the tips on their
/// targets under the cones, clearances and limits. Replaces `point` if that `improved` it: a
/// solution with tips within config.tip_target, or at least nearer to one. @return evaluations
/// used.
int SolveSlsqp(const IkTerms& terms, IkPoint* point, IkPoint* scratch, bool* improved);

/// Within a few centimetres and a third of a radian of `centre`.
HandConfiguration SampleNear(const HandModel& hand, const HandConfiguration& centre, Rng& rng);

/// A random start: of config.start_candidates random postures, each placed so that tips and pads
/// meet the contacts as well as a rigid motion can (Kabsch 1976), the one of least cost.
HandConfiguration SampleStart(const IkTerms& terms, Rng& rng, IkPoint* scratch);

}  // namespace pregrasp::internal
