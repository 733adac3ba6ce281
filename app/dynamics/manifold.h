#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "app/core/math.h"
#include "app/dynamics/convex.h"

namespace pregrasp {

/// One point of a manifold. `p_W` lies midway between the two surfaces.
struct ManifoldPoint {
  Vector3 p_W;
  double phi;             ///< gap along the normal [m], negative when the shapes overlap
  std::uint32_t feature;  ///< names the pair of features, to find its impulse in the next step
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
  double x = 0.0, y = 0.0;  ///< [m]
  double phi = 0.0;
  std::uint32_t feature = 0;
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
  int num_loaded = 0;
  std::array<std::uint32_t, kMaxPoints> loaded;  ///< features that bore load in the last step
  bool crowded = false;  ///< some of the face's points are not in the plane of the four

  /// All points of the face, if some of them are left out and there is a place for them.
  std::vector<PlanarPoint>* face_points = nullptr;
  int first_face_point = 0, num_face_points = 0;
  ContactPlane plane;

  void Clear() {
    size = num_face_points = 0;
    crowded = false;
  }
  std::span<const std::uint32_t> loaded_features() const {
    return {loaded.data(), static_cast<std::size_t>(num_loaded)};
  }
  void Add(const Vector3& p_W, double phi, std::uint32_t feature) {
    points[size++] = {p_W, phi, feature};
  }
  bool Has(std::uint32_t feature) const {
    return std::any_of(points.begin(), points.begin() + size,
                       [feature](const ManifoldPoint& point) { return point.feature == feature; });
  }
};

/// How the gap between two pieces changes in a step, over the places of the contact's plane.
struct Approach {
  double at_origin = 0.0, per_x = 0.0, per_y = 0.0;

  /// @param plane  its normal points from a to b.
  Approach(const PlacedConvex& a, const PlacedConvex& b, const ContactPlane& plane);
  /// @param shift_W, turn_W  how b moves relative to a, at the plane's origin.
  /// @param nhat_W           from a to b.
  Approach(const Vector3& shift_W, const Vector3& turn_W, const Vector3& nhat_W,
           const ContactPlane& plane);

  double At(double x, double y) const { return at_origin + per_x * x + per_y * y; }
};

/// Adds those of a face's points (kMaxPlanarPoints at most) that are chosen. Four at most stand for
/// all: the deepest at the end of the step, the farthest from it, the one that makes the largest
/// triangle, and the one farthest outside that triangle. Ties within a tolerance go to the lower
/// index, so that the choice does not flicker. Those that bore load in the last step are kept too
/// where they are not in the plane of the four, as room allows: of a crowd of points almost in a
/// plane the body rests on three, and they must stay while the four change.
/// All points are kept in `face_points` if some of them are left out.
void AddFacePoints(const PlanarPoint* points, int count, const ContactPlane& plane,
                   const Approach& approach, Manifold* manifold);

}  // namespace pregrasp
