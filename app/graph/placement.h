#pragma once

#include <array>
#include <span>
#include <vector>

#include "app/geometry/signed_distance.h"
#include "app/scene/finger.h"

namespace pregrasp {

/// Where the planning fingers are on the object: for each, whether it touches, its contact point
/// p_OC [m] and the outward surface normal there. The paper's (p^1 and b^1, p^2 and b^2).
struct Placement {
  struct Contact {
    bool on = false;
    Vector3 p_OC = Vector3::Zero();
    Vector3 nhat_O = Vector3::UnitZ();
  };
  std::array<Contact, kNumPlanningFingers> fingers;

  const Contact& thumb() const { return fingers[0]; }
  const Contact& index() const { return fingers[1]; }
};

/// How far apart the fingertip spheres of a placement with both fingers on are [m]; below 0 they
/// overlap.
inline double CalcTipGap(const TipSpheres& tips, const Placement& placement) {
  const auto centre = [&](Finger finger) {
    const Placement::Contact& contact = placement.fingers[static_cast<int>(finger)];
    return tips.Centre(finger, contact.p_OC, contact.nhat_O);
  };
  return tips.CalcGap(Finger::kThumb, centre(Finger::kThumb), Finger::kIndex,
                      centre(Finger::kIndex));
}

/// Whether the object itself leaves room for the fingertip of this radius [m] that touches at the
/// contact: its sphere overlaps it nowhere by more than kOwnOverlapAllowed. Not so in a hole or a
/// groove narrower than the tip.
bool HasRoom(double radius, const Placement::Contact& contact, const SignedDistance& shape);
inline constexpr double kOwnOverlapAllowed = 3e-4;  ///< [m]

/// Judges placements in one state of the world: the score function bound to an object cloud and a
/// signed distance. Implementations are immutable and safe to call from several threads.
class PlacementScorer {
 public:
  virtual ~PlacementScorer() = default;

  /// One score in [0, 1] for each placement.
  virtual std::vector<double> Score(std::span<const Placement> placements) const = 0;

  /// The spheres of the fingers that placements are of.
  virtual TipSpheres tips() const { return {}; }

  /// True where the sphere of a fingertip touching at the contact would overlap the environment.
  virtual bool IsOccluded(Finger finger, const Placement::Contact& contact) const = 0;
};

/// One state of the world to score: the pose of every scene body and where the fingers are.
struct ScoredState {
  std::vector<RigidTransform> X_WB;  ///< in scene order, the object first
  Placement placement;
};

/// The score function bound to an object and its surroundings, for states that differ in the poses
/// of bodies too. Safe to call from several threads; batches are scored together.
class StateScorer {
 public:
  virtual ~StateScorer() = default;

  /// One score in [0, 1] for each state.
  virtual std::vector<double> Score(std::span<const ScoredState> states) const = 0;

  /// How graspable the object is in each state, in [0, 1]: by the best of all placements that keep
  /// the state's own contacts, which may be none. Without a better idea, the score of these.
  virtual std::vector<double> ScoreGraspable(std::span<const ScoredState> states) const {
    return Score(states);
  }
};

/// The point with barycentric coordinates `w` (sum 1) of triangle `t`, projected to a face of the
/// true shape (SignedDistance::ProjectToFace): what a contact is, everywhere.
Placement::Contact ContactOnTriangle(const TriangleMesh& mesh, int t, const Vector3& w,
                                     const SignedDistance& shape);

/// Maps (u, v) in [0, 1]^2 to barycentric coordinates, uniform in area (Turk 1990).
Vector3 BarycentricFromSquare(double u, double v);

}  // namespace pregrasp
