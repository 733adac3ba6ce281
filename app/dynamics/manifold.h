#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "app/core/math.h"
#include "app/dynamics/convex.h"
#include "app/dynamics/world_state.h"

namespace pregrasp {

/// One point of a manifold. `p_W` lies midway between the two surfaces.
struct ManifoldPoint {
  Vector3 p_W;
  double phi;         ///< gap along the normal [m], negative when the shapes overlap
  std::uint64_t key;  ///< names the pieces and their features, to find its impulse in the next step
};

/// The plane of a contact between faces. x and y are coordinates in the tangent plane; the axes lie
/// in one of the two surfaces, so that every (x, y) is a place on it.
struct ContactPlane {
  Vector3 p_WO;
  Vector3 x_W, y_W;
  Vector3 nhat_W;  ///< from that surface to the other

  /// The point midway between the surfaces.
  Vector3 At(double x, double y, double phi) const {
    return p_WO + x * x_W + y * y_W + 0.5 * phi * nhat_W;
  }
};

/// The points of a face, of which some may be left out: their places in the contact's plane.
/// Numbers of a kind lie side by side, for loops over all of them.
struct FacePoints {
  static constexpr int kMaxSize = 256;

  int size = 0;
  std::array<double, kMaxSize> x, y, phi;    ///< [m]
  std::array<std::uint64_t, kMaxSize> keys;  ///< as of a ManifoldPoint, less the manifold's own

  FacePoints() {}  // the arrays are filled by Add

  void Add(double x_in, double y_in, double phi_in, std::uint64_t key) {
    x[size] = x_in;
    y[size] = y_in;
    phi[size] = phi_in;
    keys[size++] = key;
  }

  using Numbers = Eigen::Map<const Eigen::ArrayXd>;
  Numbers xs() const { return {x.data(), size}; }
  Numbers ys() const { return {y.data(), size}; }
  Numbers phis() const { return {phi.data(), size}; }
};

/// Memory for the faces of a step.
class FaceStore {
 public:
  bool empty() const { return num_kept_ == 0; }
  void Clear() { num_kept_ = 0; }

  /// An empty face; the next one is the same, unless this is kept.
  FacePoints* Next() {
    if (num_kept_ == faces_.size()) faces_.push_back(std::make_unique<FacePoints>());
    faces_[num_kept_]->size = 0;
    return faces_[num_kept_].get();
  }
  void Keep() { ++num_kept_; }

 private:
  std::vector<std::unique_ptr<FacePoints>> faces_;
  std::size_t num_kept_ = 0;
};

/// Contact between two convex shapes A and B: one normal, four points that stand for all, and those
/// others that bore load in the last step or without which the shapes would overlap after this one.
struct Manifold {
  static constexpr int kMaxPoints = 8;

  Vector3 nhat_W = Vector3::UnitZ();  ///< from A to B
  int size = 0;
  std::array<ManifoldPoint, kMaxPoints> points;
  std::uint64_t key = 0;  ///< names the pieces; the points' features are added to it
  /// Points of the two bodies that bore load in the last step, of other pieces too.
  std::span<const WorldState::CachedImpulse> loaded;
  bool crowded = false;  ///< some of the face's points are not in the plane of the four
  bool round = false;    ///< the four stand for all of a disc

  FaceStore* store = nullptr;        ///< where faces are kept, if anywhere
  const FacePoints* face = nullptr;  ///< all points of the face, if some of them are left out
  ContactPlane plane;                ///< of the face

  void Clear() {
    size = 0;
    face = nullptr;
    crowded = round = false;
  }
  /// An empty face: the store's next, or `own` if there is no store.
  FacePoints& NextFace(FacePoints* own) const { return store != nullptr ? *store->Next() : *own; }
  void Add(const Vector3& p_W, double phi, std::uint64_t feature) {
    points[size++] = {p_W, phi, key + feature};
  }
  bool Has(std::uint64_t point_key) const {
    return std::any_of(points.begin(), points.begin() + size,
                       [point_key](const ManifoldPoint& p) { return p.key == point_key; });
  }
};

/// How the gap between two pieces changes in a step, over the places of the contact's plane.
struct Approach {
  double at_origin = 0.0, per_x = 0.0, per_y = 0.0;

  /// @param nhat_W  from a to b.
  Approach(const PlacedConvex& a, const PlacedConvex& b, const Vector3& nhat_W,
           const ContactPlane& plane);
  /// @param shift_W, turn_W  how b moves relative to a, at the plane's origin.
  /// @param nhat_W           from a to b.
  Approach(const Vector3& shift_W, const Vector3& turn_W, const Vector3& nhat_W,
           const ContactPlane& plane);

  /// The points' gaps at the end of the step [m].
  auto GapsAfter(const FacePoints& points) const {
    return points.phis() + at_origin + per_x * points.xs() + per_y * points.ys();
  }
};

/// Adds those of a face's points that are chosen. Four at most stand for all: the deepest at the
/// end of the step, the farthest from it, the one that makes the largest triangle, and the one
/// farthest outside that triangle. Ties within a tolerance go to the lower index, so that the
/// choice does not flicker. Those that bore load in the last step are kept too where they are not
/// in the plane of the four, as room allows: of a crowd of points almost in a plane the body rests
/// on three, and they must stay while the four change. If some points are left out, `points`, which
/// is the store's next face then, is kept.
void AddFacePoints(const FacePoints& points, const ContactPlane& plane, const Approach& approach,
                   Manifold* manifold);

}  // namespace pregrasp
