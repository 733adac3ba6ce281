#pragma once

#include <functional>
#include <vector>

#include "app/geometry/signed_distance.h"
#include "app/graph/contact_path.h"
#include "app/trajectory/plan.h"

namespace pregrasp {

/// Ranges of what an action can ask for. They follow from the scene and are the same rule for all.
struct ActionRange {
  double max_depth = 0.0;    ///< largest spring deflection [m]
  double cone = 0.0;         ///< tangent over depth; below the friction coefficient, as a margin
  double max_travel = 0.03;  ///< of the target in one knot, each axis [m]
};

/// The rule: deflections of up to three times the object's weight (at least 0.6 N, at most the
/// cap), tangents inside nine tenths of the cone.
ActionRange MakeActionRange(const Scene& scene, double max_travel);

/// Whether a finger's tip can be at a contact with every body where the plan starts.
using TipFits = std::function<bool(Finger, const Placement::Contact&)>;

/// What a finger does through a whole stage, in shares of the action's ranges.
struct SteadyPush {
  bool on = false;
  double u = 0.0, v = 0.0;             ///< place on the triangle, unbounded
  double depth = 0.5;                  ///< 0 to 1
  Vector2 tangent = Vector2::Zero();   ///< shorter than 1: the friction cone's share of the depth
  Vector3 travel_W = Vector3::Zero();  ///< each axis within -1 and 1
};

/// A flat vector of unbounded numbers, Gaussian-sampled by MPPI, and what it means on a given path:
/// for each stage and finger one number whose sign is the contact bit, two that are squashed to a
/// point of the stage's triangle, and six a knot.
class ActionSpace {
 public:
  /// @param fits  decides where fingers may be put in the first stage; may be empty: anywhere.
  ActionSpace(const ContactGraph& graph, const std::vector<int>& path_nodes,
              const SignedDistance& shape, const ActionRange& range, int knots,
              const TipSpheres& tips = {}, TipFits fits = {});

  int size() const { return num_stages_ * kNumPlanningFingers * FingerSize(); }

  /// Bit: on if positive. Position: (1 + tanh) / 2. Depth: (1 + tanh) / 2 of the range. Tangent:
  /// the vector scaled by tanh of its length, so that directions are uniform. Travel: tanh. A
  /// finger that was on in the stage before keeps its contact (paper: it may change its location
  /// only after a stage without contact). A contact of the first stage where the tip does not fit
  /// goes to the nearest of kFitGrid^2 places on the triangle where it does, if there is one. A
  /// finger for which the object itself has no room there (HasRoom) stays off.
  RelativePlan Decode(const std::vector<double>& action) const;

  /// The contact that Decode puts a finger on with these two numbers for its place.
  Placement::Contact ContactAt(int stage, int finger, double u, double v) const;

  /// Makes a finger do the same in every knot of a stage.
  void SetSteady(std::vector<double>& action, int stage, int finger, const SteadyPush& push) const;

  int num_stages() const { return num_stages_; }
  /// Whether the finger's tip fits somewhere on its triangle of the first stage.
  bool FitsFirst(int finger) const { return !fits_ || !fitting_[finger].empty(); }

 private:
  static constexpr int kKnotSize = 6;
  static constexpr int kFitGrid = 8;
  int FingerSize() const { return 3 + kKnotSize * knots_; }
  Placement::Contact PutFirst(int finger, const Placement::Contact& contact) const;

  const TriangleMesh* mesh_;
  const SignedDistance* shape_;
  std::vector<std::array<int, kNumPlanningFingers>> triangles_;  // by stage
  ActionRange range_;
  int num_stages_, knots_;
  TipSpheres tips_;
  TipFits fits_;
  std::array<std::vector<Placement::Contact>, kNumPlanningFingers> fitting_;  // of the first stage
};

}  // namespace pregrasp
