#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "app/core/math.h"
#include "app/dynamics/convex.h"
#include "app/dynamics/world.h"

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

/// A point of a face that may still be left out: its place in the contact's plane.
struct PlanarPoint {
  double x, y;  ///< [m]
  double phi;
  std::uint64_t key;
};

/// The most points of a face.
inline constexpr int kMaxPlanarPoints = 256;

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

  /// All points of the face, if some of them are left out and there is a place for them.
  std::vector<PlanarPoint>* face_points = nullptr;
  int first_face_point = 0, num_face_points = 0;
  ContactPlane plane;

  void Clear() {
    size = num_face_points = 0;
    crowded = false;
  }
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

  double At(double x, double y) const { return at_origin + per_x * x + per_y * y; }
};

/// Adds those of a face's points (kMaxPlanarPoints at most, named by their features) that are
/// chosen. Four at most stand for all: the deepest at the end of the step, the farthest from it,
/// the one that makes the largest triangle, and the one farthest outside that triangle. Ties within
/// a tolerance go to the lower index, so that the choice does not flicker. Those that bore load in
/// the last step are kept too where they are not in the plane of the four, as room allows: of a
/// crowd of points almost in a plane the body rests on three, and they must stay while the four
/// change. All points are kept in `face_points` if some of them are left out.
void AddFacePoints(const PlanarPoint* points, int count, const ContactPlane& plane,
                   const Approach& approach, Manifold* manifold);

}  // namespace pregrasp
