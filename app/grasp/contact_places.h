#pragma once

#include <array>
#include <optional>
#include <vector>

#include "app/core/rng.h"
#include "app/geometry/sharp_edges.h"
#include "app/grasp/grasp_world.h"

namespace pregrasp {

/// Where fingertips can be on the object with the bodies at given poses: contacts on its faces
/// whose fingertip sphere overlaps neither the object nor the surroundings. Immutable, safe to
/// share between threads. For the question whether an object can be grasped where it stands they
/// may include places on its edges and corners.
class ContactPlaces {
 public:
  /// A place by its number among those of one size of fingertip.
  static constexpr int kNone = -1;

  /// @param world  outlives this.
  /// @param X_WB   every body's pose, the object first.
  ContactPlaces(const GraspWorld& world, const std::vector<RigidTransform>& X_WB,
                const TouchSlack& slack = {});
  /// The same with the places that FindFreeEdgeContacts gives for `edges` and this slack between
  /// sphere and object [m].
  ContactPlaces(const GraspWorld& world, const std::vector<RigidTransform>& X_WB,
                const TouchSlack& slack, const std::vector<EdgePoint>& edges, double edge_slack);

  const GraspWorld& world() const { return world_; }
  const std::vector<RigidTransform>& X_WB() const { return X_WB_; }

  /// Samples of the object's surface (GraspWorld::surface) where the finger's tip can be, then
  /// those of edges.
  int count(Finger finger) const { return static_cast<int>(PoolOf(finger).contact.size()); }
  /// Whether places on edges and corners are among them.
  bool has_edges() const { return has_edges_; }
  GraspContact At(Finger finger, int place) const;

  /// Whether the finger can touch there, which need not be at a sample.
  bool Allows(const GraspContact& contact) const;

  /// The place nearest to p_O for the finger: the nearest point of the true surface if the tip can
  /// be there, else the nearest sample where it can. None if it can be nowhere, or p_O is not
  /// finite.
  std::optional<GraspContact> Project(Finger finger, const Vector3& p_O) const;

  /// Samples within `distance` of p_O [m], by number.
  std::vector<int> FindWithin(Finger finger, const Vector3& p_O, double distance) const;

  /// A sample at random, half of the draws by area, half by direction of the normal, so that a thin
  /// side counts like a wide one; kNone if there is none.
  int DrawAny(Finger finger, Rng& rng) const;
  /// A sample at random whose tip centre is within `distance` of `centre`; kNone if none was found.
  int DrawNear(Finger finger, const Vector3& centre, double distance, Rng& rng) const;

 private:
  // Samples that one size of fingertip can touch.
  struct Pool {
    std::vector<GraspContact> contact;
    std::vector<Vector3> centre;            // of the tip
    std::vector<std::vector<int>> buckets;  // of places, by direction of the normal
    std::array<int, 3> cells{};             // a grid over the centres
    Vector3 corner = Vector3::Zero();
    std::vector<int> cell_start, cell_points;
  };
  // The cells of a grid between two corners, both included.
  struct CellRange {
    std::array<int, 3> low{}, high{};
    bool empty() const;
  };

  Pool MakePool(Finger finger, const std::vector<EdgePoint>& edges, double edge_slack) const;
  static void MakeGrid(Pool& pool);
  static CellRange CellsAround(const Pool& pool, const Vector3& centre, double distance);
  const Pool& PoolOf(Finger finger) const { return pools_[pool_of_[static_cast<int>(finger)]]; }

  const GraspWorld& world_;
  std::vector<RigidTransform> X_WB_;
  TouchSlack slack_;
  std::vector<Pool> pools_;  // one for each size of fingertip
  std::array<int, kNumFingers> pool_of_{};
  bool has_edges_ = false;
};

}  // namespace pregrasp
