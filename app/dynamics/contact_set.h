#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "app/dynamics/convex.h"
#include "app/dynamics/indices.h"
#include "app/dynamics/manifold.h"
#include "app/dynamics/motion.h"
#include "app/dynamics/world_state.h"
#include "app/scene/scene.h"

namespace pregrasp {

/// What two bodies have in common among the keys of their contacts' points.
inline constexpr std::uint64_t PairOfKey(std::uint64_t key) { return key >> 40; }

/// The impulses between the two bodies that `pair` names. Takes them and all before them off
/// `cache`, which is in the order of the pairs.
std::span<const WorldState::CachedImpulse> TakePair(
    std::uint64_t pair, std::span<const WorldState::CachedImpulse>* cache);

/// A contact between two bodies in one step: of two convex pieces, or of several pieces along one
/// plane.
struct Contact {
  BodyIndex body_a, body_b;           ///< a < b
  MovableIndex movable_a, movable_b;  ///< none for a fixed body; one is some
  double friction = 0.0;
  Manifold manifold;  ///< normal from a to b
};

/// The collision shapes of a scene and the search for contacts between them. Immutable.
class CollisionScene {
 public:
  /// Memory that FindContacts reuses from step to step.
  struct Scratch {
    std::vector<PlacedConvex> pieces;
    std::vector<Bounds> bounds;     ///< by movable
    std::vector<double> distances;  ///< that its points go in a step at most [m], by movable
    FaceStore faces;                ///< of contacts that leave some points out
  };

  CollisionScene(const Scene& scene, double margin);

  /// Largest distance of a point of body `body` from p_B (in its frame) [m].
  double CalcReach(BodyIndex body, const Vector3& p_B) const;

  MovableIndex movable_index(BodyIndex body) const { return bodies_.at(body.value).movable; }

  /// All contacts with a movable body, in an order that depends on the scene alone. Pieces count as
  /// in contact when they are nearer than the margin plus the distance they can cover in `dt`, so
  /// that a body stops at the surface instead of inside it.
  /// @param motions  one per movable, velocities as predicted without contacts.
  /// @param cache  impulses of the last step: points that bore load stay in contact.
  void FindContacts(const std::vector<BodyKernel>& kernels, const std::vector<BodyMotion>& motions,
                    const std::vector<WorldState::CachedImpulse>& cache, double dt,
                    Scratch* scratch, std::vector<Contact>* contacts) const;

  /// Adds to each contact the point left out that would overlap most after the step, if any would
  /// sink in and deeper than those that are not left out.
  /// @param steps  one per movable: how the step takes it once `contacts` have acted.
  /// @returns whether there is one.
  static bool AddOverlapping(const std::vector<BodyMotion>& motions,
                             const std::vector<BodyStep>& steps, std::vector<Contact>* contacts);

 private:
  struct CollisionBody {
    MovableIndex movable;              ///< none for a fixed body
    Vector3 p_BBox = Vector3::Zero();  ///< centre of the bounding box in the body's frame
    Vector3 half = Vector3::Zero();
    std::vector<Convex> pieces;
    int first_placed = 0;  ///< into placed_ for a fixed body, into Scratch::pieces for a movable
  };
  struct Pair {
    BodyIndex a, b;
    double friction;
  };

  /// The pieces of a body at their poses.
  const PlacedConvex* Placed(const CollisionBody& body, const Scratch& scratch) const {
    return (body.movable.is_none() ? placed_.data() : scratch.pieces.data()) + body.first_placed;
  }
  const Bounds& GetBounds(BodyIndex body, const Scratch& scratch) const {
    const MovableIndex movable = bodies_[body.value].movable;
    return movable.is_none() ? fixed_bounds_[body.value] : scratch.bounds[movable.value];
  }
  void PlaceMovables(const std::vector<BodyKernel>& kernels, const std::vector<BodyMotion>& motions,
                     double dt, Scratch* scratch) const;
  void CollidePair(const Pair& pair, double margin, Scratch* scratch,
                   std::span<const WorldState::CachedImpulse> loaded,
                   std::vector<Contact>* contacts) const;
  void MergeCoplanar(std::size_t first, Scratch* scratch, std::vector<Contact>* contacts) const;

  double margin_;
  std::vector<CollisionBody> bodies_;
  std::vector<PlacedConvex> placed_;  ///< pieces of fixed bodies
  std::vector<Bounds> fixed_bounds_;  ///< by body; movables unset
  std::vector<Pair> pairs_;
  int num_movable_pieces_ = 0;
};

}  // namespace pregrasp
